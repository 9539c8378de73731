#!/usr/bin/env bash
# scripts/test.sh [--quick] [CTEST ARGS...]: installs what is missing, builds with warnings as errors, runs every test.
# Then, unless --quick: the quick tests under AddressSanitizer and UndefinedBehaviorSanitizer, the tests of derivatives as
# compiled by clang, formatting, clang-tidy. The arguments go to the release run of ctest, as in
# scripts/test.sh --quick -R Wavelet. Each step runs whatever became of those before it; the exit code is 0 if all passed.
set -uo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"

case ${1-} in -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;; esac
quick=no
if [[ ${1-} == --quick ]]; then quick=yes; shift; fi
ctest_args=("$@")

results=() failed=0
# step NAME COMMAND...: runs one step and notes how it went.
step() {
  local name=$1 begin=$SECONDS verdict=passed; shift
  printf '\n== %s\n' "$name"
  "$@" || { verdict=FAILED; failed=1; }
  results+=("$(printf '%-7s %4d s  %s' "$verdict" $((SECONDS - begin)) "$name")")
  [[ $verdict == passed ]]
}
skip() { results+=("$(printf '%-7s         %s' skipped "$1: $2")"); }

# sources: the C++ files below src and tests, one per line.
sources() { find "$root/src" "$root/tests" \( -name '*.cpp' -o -name '*.h' \) -print | sort; }

# Three at once: scripts that wait for progress lines leave a core idle.
release_tests() {
  ctest --test-dir "$root/build/release" -j3 --output-on-failure "${ctest_args[@]}" 2>&1 | tee "$root/build/ctest.log"
}

# Embree, TBB and OpenImageIO keep what they allocate until the process ends, so leaks in them are not looked for.
# Each program in one go, which is quicker than a process for each test; of the commands those that read what users write.
asan_tests() {
  local unit status=0
  export ASAN_OPTIONS=detect_leaks=0:strict_string_checks=1:detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
  { "$root/build/asan/tests/h2mc_unit_tests" --gtest_brief=1 --gtest_filter=-'*Slow*' &&
    "$root/build/asan/tests/h2mc_stress_tests" --gtest_brief=1 --gtest_filter=-'*Slow*'; } &
  unit=$!
  "$root/build/asan/tests/h2mc_derivative_tests" --gtest_brief=1 --gtest_filter=-'*Slow*' || status=1
  wait "$unit" || status=1
  ctest --test-dir "$root/build/asan" -j2 --output-on-failure -L '^cli$' -E 'slow|cli_(render|compare|demo|gradcheck|stress|inspect|motion)' || status=1
  unset ASAN_OPTIONS UBSAN_OPTIONS
  return "$status"
}

clang_tests() { ctest --test-dir "$root/build/clang" -j2 --output-on-failure -L '^(ad|derivative)$'; }

formatting() {
  local files
  files=$(sources | tr '\n' '\0' | xargs -0 -r clang-format --dry-run -Werror 2>&1 |
    sed -n 's/:[0-9]*:[0-9]*: error: .*//p' | sort -u)
  [[ -z $files ]] && return
  printf 'Not as clang-format has it; clang-format -i on them puts it right:\n%s\n' "$files"
  return 1
}

# The files that were changed last, as many as fit a minute or two.
tidy() {
  local files
  mapfile -t files < <(
    { git -C "$root" log -100 --format= --name-only -- 'src/*.cpp' 2>/dev/null; cd "$root" && find src -name '*.cpp' | sort; } |
      awk '!seen[$0]++' | while IFS= read -r file; do [[ -e $root/$file ]] && printf '%s\n' "$file"; done | head -n 8)
  ((${#files[@]})) || return 0
  printf '%s\n' "${files[@]}"
  (cd "$root" && printf '%s\0' "${files[@]}" | timeout 170 xargs -0 -n1 -P2 clang-tidy --quiet -p build/clang 2> >(
    grep -Ev 'warnings? (generated|treated as error)|^Suppressed|^Use -header-filter' >&2))
  local status=$?
  ((status == 124)) && printf 'Out of time: not all of these were looked at.\n' && return 0
  return "$status"
}

ensure_packages build test
build_options=(-DH2MC_WERROR=ON -DH2MC_BUILD_TESTS=ON)

if step "build: release, warnings are errors" build release all "${build_options[@]}"; then
  step "tests: release" release_tests
else
  skip "tests: release" "not built"
fi

if [[ $quick == no ]]; then
  if step "build: address and undefined-behaviour sanitizers" \
      build asan all "-DH2MC_TEST_FOLDERS=unit;derivative;stress" -DH2MC_BUILD_BENCHMARKS=OFF; then
    step "tests: unit, derivative, stress and cli under the sanitizers" asan_tests
  else
    skip "tests: unit, derivative, stress and cli under the sanitizers" "not built"
  fi
  if command -v clang++ >/dev/null; then
    if step "build: clang, warnings are errors" \
      build clang all "${build_options[@]}" "-DH2MC_TEST_FOLDERS=ad;derivative" -DH2MC_BUILD_BENCHMARKS=OFF; then
      step "tests: ad and derivative, compiled by clang" clang_tests
    else
      skip "tests: ad and derivative, compiled by clang" "not built"
    fi
  else
    skip "build: clang" "no clang++"
  fi
  if command -v clang-format >/dev/null; then step formatting formatting; else skip formatting "no clang-format"; fi
  if command -v clang-tidy >/dev/null && [[ -e $root/build/clang/compile_commands.json ]]; then
    step "clang-tidy: the files changed last" tidy
  else
    skip clang-tidy "no clang-tidy, or nothing configured for clang"
  fi
fi

printf '\n== summary, %d s\n' "$SECONDS"
printf '%s\n' "${results[@]}"
grep -E '^[0-9]+% tests passed' "$root/build/ctest.log" 2>/dev/null | tail -n 1
exit "$failed"
