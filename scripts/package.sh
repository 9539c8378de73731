#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/package.sh [--try]: makes a Debian package for any x86-64 processor, build/package/h2mc_..._amd64.deb:
# installs what is missing, builds the preset sse2 in build/sse2, packs. With H2MC_PACKAGE_PRESET=avx2 one for
# processors with AVX2. --try unpacks the package into a folder and renders there; then, where there are root and
# debootstrap, installs it in a bare Debian 12 (build/package/try) and renders there.
# The Python module is not in it: that is for one interpreter alone. Nor is the module for MPI, which would bring MPI
# with it. DEBFULLNAME and DEBEMAIL say who answers for the package.
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"
source "$root/scripts/bare-debian.sh"

case ${1-} in
  '' | --try) ;;
  -h | --help) sed -n '2,/^set/{/^set/d;/SPDX/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  *) say "unknown argument \"$1\"; there is --try"; exit 2 ;;
esac
preset=${H2MC_PACKAGE_PRESET:-sse2}
folder="$root/build/package"

# What a user does with it first, on the scene that comes with it; $1 stands before each path. (No single quotes: it is
# quoted by them.)
main_job='
  set -e
  scene="$1/usr/share/h2mc/scenes/ring/ring.xml"
  PATH="$1/usr/bin:$PATH"
  cd "$(mktemp -d)"
  h2mc --version
  for seed in 1 2; do
    h2mc render "$scene" --width 64 --height 48 -m 64 --seed $seed -q -o $seed.exr --png
  done
  h2mc merge 1.exr 2.exr -o both.exr
  h2mc diff 1.png 2.png --metric relmse
  for file in bash-completion/completions/h2mc zsh/site-functions/_h2mc fish/vendor_completions.d/h2mc.fish \
      man/man1/h2mc.1* man/man1/h2mc-render.1* doc/h2mc/copyright; do
    test -s "$1/usr/share"/$file
  done'

# In a bare system: by apt, which has to find all that the package depends on.
try_installed() {
  make_bare "$folder/try"
  cp "$1" "$folder/try/root/tmp/h2mc.deb"
  say "installing the package in a bare Debian 12"
  inside_bare "$folder/try" root "apt-get -qq update && DEBIAN_FRONTEND=noninteractive \
    apt-get -qq install -y --no-install-recommends /tmp/h2mc.deb" >"$folder/try/install.log" 2>&1 ||
    { cat "$folder/try/install.log" >&2; return 1; }
  inside_bare "$folder/try" visitor "bash -c '$main_job' - ''"
  inside_bare "$folder/try" root "apt-get -qq remove -y h2mc >/dev/null 2>&1; ! test -e /usr/bin/h2mc"
}

# Unpacked: with this machine's libraries. No library's path may lead into the build folder.
try_unpacked() {
  local place; place=$(mktemp -d)
  dpkg-deb -x "$1" "$place"
  local file
  for file in "$place/usr/bin/h2mc" $(find "$place" -name '*.so'); do
    if readelf -d "$file" | grep -E 'R(UN)?PATH' | grep -vF '[$ORIGIN/'; then
      say "$file looks for libraries in folders of this machine"
      return 1
    fi
  done
  bash -c "$main_job" - "$place"
  rm -rf "$place"
}

ensure_packages build package
build "$preset" all -DH2MC_BUILD_TESTS=OFF -DH2MC_BUILD_BENCHMARKS=OFF -DH2MC_PYTHON=OFF -DH2MC_MPI=OFF
mkdir -p "$folder"
rm -f "$folder"/*.deb
(cd "$root/build/$preset" && cpack -G DEB -B "$folder") >"$folder/cpack.log" 2>&1 ||
  { cat "$folder/cpack.log" >&2; say "cpack failed; its output is above"; exit 1; }
rm -rf "$folder/_CPack_Packages"
package=$(echo "$folder"/*.deb)
say "made $package"
dpkg-deb --field "$package" Package Version Architecture Installed-Size Depends >&2

[[ ${1-} == --try ]] || exit 0
try_unpacked "$package"
if can_make_bare; then
  try_installed "$package"
  say "passed: installed in a bare Debian 12, and unpacked"
else
  say "passed: unpacked; not tried in a bare Debian 12"
fi
