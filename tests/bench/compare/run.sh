#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# tests/bench/compare/run.sh [OUTPUT FOLDER] [H2MC COMPARE OPTIONS...]: the project's standing comparison, less than two
# minutes a scene. Every scene of the repository against its own reference, at the reference's size; each integrator
# with the scenes' own options. Interrupted, the same command goes on. Options that are given replace these, as in
#   run.sh results --time 5,10,20,40 --reference auto
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../../.." >/dev/null && pwd)
output=${1:-$root/build/standing-comparison}
shift || true

scenes=()
for folder in "$root"/scenes/*/; do
  name=$(basename "$folder")
  # It tells right from wrong, not better from worse: everything about it is known.
  [[ $name != furnace && -e $folder$name.xml ]] && scenes+=("$folder$name.xml")
done

options=()
option() { # unless it is given
  [[ " $arguments " == *" $1 "* || " $arguments " == *" $2 "* ]] || options+=("$2" "$3")
}
arguments=$*
option -i --integrators path,bdpt,mmlt,h2mc
option -k --repeats 3
option -t --time 2,4,8
option -r --reference "$root/scenes/{scene}/reference.exr"
exec "$root/scripts/run.sh" compare "${scenes[@]}" "${options[@]}" -o "$output" "$@"
