#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/fresh-root.sh [--sudo] [FOLDER]: what somebody meets who has Debian 12 and nothing else. Makes a bare Debian
# 12 in FOLDER (build/fresh-root if none is given), clones the last commit into it and runs there the README's two
# commands: as root, or with --sudo as a user who may use sudo. Before that it checks that a user who may not is told
# what to install. Needs root and debootstrap; mirror and proxy are those of this machine's apt.
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"

who=root
if [[ ${1-} == --sudo ]]; then who=visitor; shift; fi
folder=${1:-$root/build/fresh-root}
((EUID == 0)) || { say "making a root file system needs root"; exit 2; }
command -v debootstrap >/dev/null || { say "needs debootstrap: apt-get install debootstrap"; exit 2; }
mkdir -p "$folder"
folder=$(cd -P -- "$folder" && pwd)

# "<address> <release>" of each Debian 12 archive that this machine's apt knows.
archives=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
  sed -n 's/^\([^ ]* bookworm[^ ]*\) main$/\1/p' | sort -u)
mirror=$(sed -n 's/ bookworm$//p' <<<"$archives" | head -n 1)
: "${mirror:=http://deb.debian.org/debian}"
[[ -n $archives ]] || archives="$mirror bookworm"

if [[ ! -e $folder/bare.done ]]; then
  say "making a bare Debian 12"
  proxy=$(apt-config dump --format '%v' Acquire::http::Proxy || true)
  rm -rf --one-file-system "$folder/bare"
  env ${proxy:+http_proxy="$proxy"} debootstrap --variant=minbase bookworm "$folder/bare" "$mirror" \
    >"$folder/debootstrap.log" 2>&1 ||
    { cat "$folder/debootstrap.log" >&2; exit 1; }
  sed 's/^/deb /; s/$/ main/' <<<"$archives" >"$folder/bare/etc/apt/sources.list"
  apt-config dump | grep -E '^Acquire::(https?::Proxy|Check-)' >"$folder/bare/etc/apt/apt.conf.d/90host" || true
  cp -L /etc/resolv.conf "$folder/bare/etc/resolv.conf"
  touch "$folder/bare.done"
fi

new="$folder/root"
home="/home/visitor/a folder" # with a space, as folders have
rm -rf --one-file-system "$new"
cp -a --reflink=auto "$folder/bare" "$new"
chroot "$new" useradd -m -s /bin/bash visitor
mkdir -p "$new$home"
git -c safe.directory='*' clone -q --no-hardlinks "$root" "$new$home/h2mc"
chroot "$new" chown -R visitor: /home/visitor

# inside USER COMMAND: runs it in the clone, with an environment as bare as the system.
inside() {
  unshare --mount --pid --fork -- bash -c '
    mount -t proc proc "$1/proc" && mount -t devpts -o newinstance,ptmxmode=666 devpts "$1/dev/pts" && shift &&
    exec env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/tmp "$@"' - \
    "$new" chroot --userspec="$1" "$new" bash -c "cd '$home/h2mc' && $2" </dev/null
}

say "as a user without root and sudo"
status=0
inside visitor "scripts/run.sh list" || status=$?
((status == 2)) || { say "exit code $status where 2 was to be expected"; exit 1; }

if [[ $who == visitor ]]; then
  inside root "apt-get -qq update && apt-get -qq install -y --no-install-recommends sudo" >"$folder/sudo.log" 2>&1
  echo "visitor ALL=(ALL) NOPASSWD: ALL" >"$new/etc/sudoers.d/visitor"
fi

# The first lines of the README that call a script.
mapfile -t commands < <(
  awk 'sub(/^ *(\$ )?(\.\/)?scripts\//, "scripts/") { print; found = 1; next } found { exit }' "$root/README.md")
((${#commands[@]})) || commands=("scripts/run.sh list")
for command in "${commands[@]}"; do
  say "as $who: $command"
  begin=$SECONDS
  inside "$who" "$command"
  say "took $((SECONDS - begin)) s"
done
say "passed; the root is in $new"
