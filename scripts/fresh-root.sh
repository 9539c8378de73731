#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/fresh-root.sh [--sudo] [FOLDER]: what somebody meets who has Debian 12 and nothing else. Makes a bare Debian
# 12 in FOLDER (build/fresh-root if none is given), clones the last commit into it and runs there the README's two
# commands: as root, or with --sudo as a user who may use sudo. Before that it checks that a user who may not is told
# what to install. Needs root and debootstrap; mirror and proxy are those of this machine's apt.
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"
source "$root/scripts/bare-debian.sh"

who=root
if [[ ${1-} == --sudo ]]; then who=visitor; shift; fi
folder=${1:-$root/build/fresh-root}
can_make_bare || exit 2
mkdir -p "$folder"
folder=$(cd -P -- "$folder" && pwd)

make_bare "$folder"
new="$folder/root"
home="/home/visitor/a folder" # with a space, as folders have
mkdir -p "$new$home"
git -c safe.directory='*' clone -q --no-hardlinks "$root" "$new$home/h2mc"
chroot "$new" chown -R visitor: /home/visitor

# inside USER COMMAND: runs it in the clone.
inside() { inside_bare "$folder" "$1" "cd '$home/h2mc' && $2"; }

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
