#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/fuzz.sh [SECONDS [TARGET...]]: builds the programs of tests/fuzz with libFuzzer and sanitizers and gives each
# (or those named: xml, obj, ply, serialized, image, path_text, checkpoint) so many seconds (default 60), one a core at
# a time. What leads to new code is kept in build/fuzz/corpus and begun from the next time. Exit code 1 on a finding;
# its input is kept in build/fuzz/findings, and is tried again by: build/fuzz/tests/fuzz/h2mc_fuzz_TARGET FILE
set -uo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"

case ${1-} in -h | --help) sed -n '2,/^set/{/^set/d;/SPDX/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;; esac
seconds=${1-60}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { say "expected a number of seconds, got \"$seconds\""; exit 2; }
(($#)) && shift
all=(xml obj ply serialized image path_text checkpoint)
targets=("$@")
(($#)) || targets=("${all[@]}")
for target in "${targets[@]}"; do
  [[ " ${all[*]} " == *" $target "* ]] || { say "no target \"$target\"; there are: ${all[*]}"; exit 2; }
done

ensure_packages build test
folder="$root/build/fuzz"
for target in "${targets[@]}"; do build fuzz "h2mc_fuzz_$target" || exit; done

# Libraries keep what they allocate; leaks are looked for in the unit tests.
export ASAN_OPTIONS=detect_leaks=0:strict_string_checks=1:allocator_may_return_null=0
export UBSAN_OPTIONS=print_stacktrace=1
# Inputs are written to files, in a folder that goes with this script.
inputs=$(mktemp -d -t h2mc-fuzz-XXXXXX)
trap 'rm -rf "$inputs"' EXIT
export TMPDIR=$inputs
mkdir -p "$folder/findings" "$folder/logs"

# fuzz TARGET: its last line says what came of it.
fuzz() {
  local target=$1 log="$folder/logs/$1.log" before
  mkdir -p "$folder/corpus/$target"
  before=$(find "$folder/findings" -name "$target-*" | wc -l)
  if "$folder/tests/fuzz/h2mc_fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
      -print_final_stats=1 -artifact_prefix="$folder/findings/$target-" \
      "$folder/corpus/$target" "$root/tests/fuzz/corpus/$target" >"$log" 2>&1; then
    printf '%-10s nothing found in %s inputs, %s\n' "$target" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
      "$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1 | sed 's/cov: \(.*\)/\1 edges of the code reached/')"
    return 0
  fi
  printf '%-10s FOUND: %s\n' "$target" "$(grep -m 1 -E '^FINDING|ERROR: |runtime error' "$log" | cut -c1-200)"
  (($(find "$folder/findings" -name "$target-*" | wc -l) > before)) &&
    printf '%10s input:  %s\n' '' \
      "$(find "$folder/findings" -name "$target-*" -printf '%T@ %p\n' | sort -n | tail -n 1 | cut -d' ' -f2-)"
  printf '%10s log:    %s\n' '' "$log"
  return 1
}

status=0 running=0
for target in "${targets[@]}"; do
  if ((running == $(nproc))); then
    wait -n || status=1
    running=$((running - 1))
  fi
  fuzz "$target" &
  running=$((running + 1))
done
while ((running > 0)); do
  wait -n || status=1
  running=$((running - 1))
done
exit "$status"
