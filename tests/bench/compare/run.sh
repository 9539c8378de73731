#!/usr/bin/env bash
# tests/bench/compare/run.sh [OUTPUT FOLDER] [H2MC COMPARE OPTIONS...]: the project's standing comparison, about
# 40 minutes a scene with its reference. Every scene of the repository, and the published torus where H2MC_DATA_DIR says
# that it is; each integrator with the scenes' own options. Interrupted, the same command goes on.
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../../.." >/dev/null && pwd)
output=${1:-$root/build/standing-comparison}
shift || true

scenes=()
for folder in "$root"/scenes/*/; do
  name=$(basename "$folder")
  [[ -e $folder$name.xml ]] && scenes+=("$folder$name.xml")
done
torus=${H2MC_DATA_DIR:-$root/../shared/data}/torus/torus.xml
[[ -e $torus ]] && scenes+=("$torus")

exec "$root/scripts/run.sh" compare "${scenes[@]}" --integrators path,bdpt,mmlt,h2mc --time 5,10,20,40 --repeats 3 \
  --width 512 --reference auto -o "$output" "$@"
