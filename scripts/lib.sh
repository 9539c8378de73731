# SPDX-License-Identifier: MIT
# What run.sh and test.sh share. To be sourced; $root is the repository's folder. Everything here talks on stderr only.

say() { printf 'h2mc: %s\n' "$*" >&2; }

# ensure_packages build|test...: installs what scripts/packages.txt lists for these purposes and the machine lacks. With
# build alone, wishes are no reason to install anything, but come along.
# Asks dpkg each time: that takes 20 ms, and unlike a stamp it is never wrong.
ensure_packages() {
  command -v dpkg-query >/dev/null || return 0  # not a Debian: CMake says what is missing
  local purpose package instead wanted=() missing=() wishes=" " needed=0
  while read -r purpose package instead; do
    [[ " $* wish " == *" $purpose "* ]] || continue
    [[ -n $instead ]] && command -v "$instead" >/dev/null && continue
    wanted+=("$package")
    [[ $purpose == wish && $* == build ]] && wishes+="$package "
  done <"$root/scripts/packages.txt"
  ((${#wanted[@]})) || return 0
  local present
  present=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null || true)
  for package in "${wanted[@]}"; do
    grep -qxF "installed $package" <<<"$present" && continue
    missing+=("$package")
    [[ $wishes == *" $package "* ]] || needed=1
  done
  ((needed)) || return 0

  local as_root=()
  if ((EUID != 0)); then
    # A password may be asked for where there is somebody to ask.
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [[ -t 0 && -t 2 ]] && sudo -v; }; }; then
      as_root=(sudo)
    else
      say "these packages are missing, and installing them needs root: ${missing[*]}
As root, run:  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
      exit 2
    fi
  fi
  say "installing ${#missing[@]} packages and what they need; this takes a few minutes: ${missing[*]}"
  local log; log=$(mktemp)
  # A source that can't be reached needn't matter to these packages, so only the installation's verdict counts.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 update >"$log" 2>&1 || true
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 install -y \
      --no-install-recommends "${missing[@]}" >>"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    rm -f "$log"
    say "installing failed; the output of apt-get is above"
    exit 2
  fi
  rm -f "$log"
}

# show_progress: passes on the counter of a build ("[12/80] Building ..."), in place on a terminal, sparsely elsewhere.
show_progress() {
  local line shown=-1 decile
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\  ]] || continue
    [[ $line == *"Re-checking globbed"* ]] && continue
    if [[ -t 2 ]]; then
      printf '\r\033[K%.*s' "${COLUMNS:-79}" "$line" >&2
    else
      decile=$((10 * BASH_REMATCH[1] / BASH_REMATCH[2]))
      ((decile > shown)) && printf 'h2mc: building, %s of %s\n' "${BASH_REMATCH[@]:1:2}" >&2
      shown=$decile
    fi
  done
  [[ -t 2 && -n ${line+x} ]] && printf '\r\033[K' >&2
  return 0
}

# run_logged LOG COMMAND...: runs it silently but for the progress; on failure shows all that it had to say.
run_logged() {
  local log=$1 status=0; shift
  "$@" 2>&1 </dev/null | tee "$log" | show_progress
  status=${PIPESTATUS[0]}
  if ((status)); then
    grep -Ev '^\[ *[0-9]+(/[0-9]+|%)\] ' "$log" >&2
    say "failed: $*"
  fi
  return "$status"
}

# build PRESET TARGET [-DOPTION=VALUE...]: brings build/PRESET up to date, one at a time. Options are for CMake's
# cache; without any, a folder that has been configured keeps the ones it has.
build() {
  local preset=$1 target=$2; shift 2
  local folder="$root/build/$preset" generator=() lock
  mkdir -p "$folder" || return
  exec {lock}>"$folder/.lock"
  flock -n "$lock" || { say "waiting for another build of $folder"; flock "$lock"; }

  local configured=no made_for
  if [[ -e $folder/CMakeCache.txt ]]; then
    made_for=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$folder/CMakeCache.txt")
    if [[ ! $made_for -ef $root ]]; then
      say "$folder was made for ${made_for:-another place}; starting it afresh"
      rm -rf "$folder"/{CMakeCache.txt,CMakeFiles,build.ninja,Makefile}
    elif [[ -e $folder/build.ninja || -e $folder/Makefile ]]; then
      configured=yes
    fi
  fi
  if [[ ! -e $folder/CMakeCache.txt ]] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
  local status=0
  if (($#)) || [[ $configured == no ]]; then
    (cd "$root" && run_logged "$folder/configure.log" cmake --preset "$preset" "${generator[@]}" "$@") || status=$?
  fi
  if ((!status)); then
    run_logged "$folder/build.log" cmake --build "$folder" --target "$target" \
      --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" || status=$?
  fi
  exec {lock}>&-
  return "$status"
}
