#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/test.sh [--quick] [CTEST ARGS...]: installs what is missing, builds with warnings as errors, runs every test.
# Then, unless --quick: the quick tests as compiled by clang, under AddressSanitizer and UndefinedBehaviorSanitizer; the
# tests of the AD type as optimised by clang; formatting, licences, clang-tidy. The arguments go to the release run of
# ctest, as in scripts/test.sh --quick -R Wavelet. Each step runs whatever became of those before it; the exit code is 0
# if all passed. H2MC_TIDY=all has clang-tidy look at all files, however long it takes; H2MC_TSAN=yes adds the tests of
# threads under ThreadSanitizer, H2MC_LEAKS=yes leak checks; H2MC_THOROUGH=yes makes the 200 renders by which error bars
# are tested.
set -uo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"

case ${1-} in -h | --help) sed -n '2,/^set/{/^set/d;/SPDX/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;; esac
quick=no
if [[ ${1-} == --quick ]]; then quick=yes; shift; fi
ctest_args=("$@")

results=() failed=0
# step NAME COMMAND...: runs one step and notes how it went.
step() {
  local name=$1 begin=$SECONDS verdict=passed; shift
  printf '\n== %s\n' "$name"
  "$@" || { verdict=FAILED; failed=1; }
  printf -- '-- %s, %d s: %s\n' "$verdict" $((SECONDS - begin)) "$name"
  results+=("$(printf '%-7s %4d s  %s' "$verdict" $((SECONDS - begin)) "$name")")
  [[ $verdict == passed ]]
}
skip() { results+=("$(printf '%-7s         %s' skipped "$1: $2")"); }

# sources: the C++ files below src and tests, one per line.
sources() { find "$root/src" "$root/tests" \( -name '*.cpp' -o -name '*.h' \) -print | sort; }

# Three at once: scripts that wait for progress lines leave a core idle.
release_tests() {
  ctest --test-dir "$root/build/release" -j3 --output-on-failure --output-junit "$reports/release.xml" \
    "${ctest_args[@]}" 2>&1 | tee "$root/build/ctest.log"
}

# run_whole PRESET FOLDER FILTER: a test program in one go, where a process for each test would take long to start.
run_whole() {
  "$root/build/$1/tests/h2mc_$2_tests" --gtest_brief=1 --gtest_filter="$3" --gtest_output="json:$reports/$1-$2.json"
}

# Leaks are looked for in the test programs, where tests/sanitizers/lsan.supp names the libraries that keep what they
# allocate. Of the commands those are tried that read what users write.
asan_tests() {
  local unit status=0
  export UBSAN_OPTIONS=print_stacktrace=1
  export LSAN_OPTIONS="suppressions=$root/tests/sanitizers/lsan.supp:print_suppressions=0"
  local leaks=0; [[ -n ${H2MC_LEAKS-} ]] && leaks=1
  export ASAN_OPTIONS=detect_leaks=$leaks:strict_string_checks=1:detect_stack_use_after_return=1
  { run_whole asan unit '-*Slow*' && run_whole asan stress '-*Slow*'; } &
  unit=$!
  run_whole asan derivative '-*Slow*' || status=1
  run_whole asan statistical "$quick_statistical" || status=1
  wait "$unit" || status=1
  export ASAN_OPTIONS=${ASAN_OPTIONS/detect_leaks=1/detect_leaks=0}
  ctest --test-dir "$root/build/asan" -j2 --output-on-failure --output-junit "$reports/asan-cli.xml" \
    -L '^cli$' -E 'slow|cli_(render|compare|demo|gradcheck|stress|inspect|motion|mpi)' || status=1
  ctest --test-dir "$root/build/asan" -j2 --output-on-failure --output-junit "$reports/asan-fuzz.xml" -L '^fuzz$' ||
    status=1
  unset ASAN_OPTIONS LSAN_OPTIONS UBSAN_OPTIONS
  return "$status"
}
# The statistical tests under it, by name, so that new ones don't make it longer: the samplers' densities and the chains
# on known targets, together 8 s of processor time without it.
quick_statistical='BsdfSampling.*:LightSampling.*:Kernels/ChainOn*-*Slow*'

# dlopen is called by the sanitizer's library there, which does not know the program's RUNPATH.
tsan_tests() {
  LD_LIBRARY_PATH="$root/build/tsan/modules" \
    TSAN_OPTIONS="suppressions=$root/tests/sanitizers/tsan.supp:history_size=4" run_whole tsan threads '-*Slow*'
}

formatting() {
  local files
  files=$(sources | tr '\n' '\0' | xargs -0 -r clang-format --dry-run -Werror 2>&1 |
    sed -n 's/:[0-9]*:[0-9]*: error: .*//p' | sort -u)
  [[ -z $files ]] && return
  printf 'Not as clang-format has it; clang-format -i on them puts it right:\n%s\n' "$files"
  return 1
}

# Characters, not bytes; of pages only what is code.
line_lengths() {
  local lines
  lines=$(cd "$root" && LC_ALL=C.UTF-8 grep -rnE '.{121,}' src tests scripts cmake .ci CMakeLists.txt \
    --include='*.'{cpp,h,in,js,html,css,py,sh,cmake,txt} | cut -c1-150)
  [[ -z $lines ]] && return
  printf 'Longer than 120 characters:\n%s\n' "$lines"
  return 1
}

# Every file says its licence in its first lines.
licences() {
  local files
  files=$(cd "$root" && find src tests scripts cmake scenes .ci CMakeLists.txt -type f \
    -regextype posix-extended -regex '.*(\.(cpp|h|js|css|py|sh|cmake|cpp\.in)|CMakeLists\.txt|run)' \
    -exec grep -LE 'SPDX-License-Identifier: (MIT|BSD-3-Clause)( |$)' {} +)
  [[ -z $files ]] && return
  printf 'Without a line "SPDX-License-Identifier: MIT":\n%s\n' "$files"
  return 1
}

# A fourteenth of the files, another one each day, and those of the last twenty commits, twelve at most. Running out of
# time is a failure: a file that nobody has looked at has not passed. What is generated has to be there; precompiled
# headers must not be asked for, as the program itself is not built there.
tidy() {
  local parts=14 limit=900 all recent files=() i
  build clang h2mc_version_header || return
  mapfile -t all < <(cd "$root" && find src -name '*.cpp' | sort)
  mapfile -t recent < <(git -C "$root" log -20 --format= --name-only -- 'src/*.cpp' 2>/dev/null | awk '!seen[$0]++' |
    while IFS= read -r file; do [[ -e $root/$file ]] && printf '%s\n' "$file"; done | head -n 12)
  if [[ ${H2MC_TIDY-} == all ]]; then parts=1 limit=0; fi
  for i in "${!all[@]}"; do
    ((i % parts == $(date +%s) / 86400 % parts)) && files+=("${all[i]}")
  done
  mapfile -t files < <(printf '%s\n' "${recent[@]}" "${files[@]}" | awk 'NF && !seen[$0]++')
  printf '%d of %d files\n' "${#files[@]}" "${#all[@]}"
  (cd "$root" && printf '%s\0' "${files[@]}" | timeout "$limit" xargs -0 -n1 -P2 clang-tidy --quiet -p build/clang 2> >(
    grep -Ev 'warnings? (generated|treated as error)|^Suppressed|^Use -header-filter' >&2))
  local status=$?
  ((status == 124)) && printf 'Out of time after %d s: not all of these were looked at:\n%s\n' "$limit" "${files[*]}"
  return "$status"
}

skips() {
  local found=("$reports"/*)
  [[ -e ${found[0]} ]] || return 0
  if command -v python3 >/dev/null; then python3 "$root/scripts/skipped.py" "${found[@]}"; fi
}

reports="$root/build/reports"
rm -rf "$reports" && mkdir -p "$reports" || exit
ensure_packages build test
build_options=(-DH2MC_WERROR=ON -DH2MC_BUILD_TESTS=ON)

if step "build: release, warnings are errors" build release all "${build_options[@]}" -UH2MC_TEST_FOLDERS; then
  step "tests: release" release_tests
else
  skip "tests: release" "not built"
fi

if [[ $quick == no ]]; then
  if ! command -v clang++ >/dev/null; then
    skip "build: clang" "no clang++"
  else
    if step "build: clang with address and undefined-behaviour sanitizers, warnings are errors" \
        build asan all -DH2MC_WERROR=ON "-DH2MC_TEST_FOLDERS=unit;derivative;stress;statistical;fuzz" \
        -DH2MC_BUILD_BENCHMARKS=OFF -DCMAKE_UNITY_BUILD=ON; then
      step "tests: unit, derivative, stress, statistical, cli and fuzz under the sanitizers" asan_tests
    else
      skip "tests: unit, derivative, stress, statistical, cli and fuzz under the sanitizers" "not built"
    fi
    if step "build: the tests of the AD type, optimised by clang" \
        build clang h2mc_ad_tests "${build_options[@]}" -DH2MC_TEST_FOLDERS=ad -DH2MC_BUILD_BENCHMARKS=OFF \
        -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON; then
      step "tests: ad, optimised by clang" run_whole clang ad '*'
    else
      skip "tests: ad, optimised by clang" "not built"
    fi
  fi
  if [[ -z ${H2MC_TSAN-} ]]; then
    skip "tests: threads under the thread sanitizer" "asked for by H2MC_TSAN=yes"
  elif step "build: thread sanitizer" build tsan h2mc_threads_tests; then
    step "tests: threads under the thread sanitizer" tsan_tests
  else
    skip "tests: threads under the thread sanitizer" "not built"
  fi
  if command -v clang-format >/dev/null; then step formatting formatting; else skip formatting "no clang-format"; fi
  step "lines' length" line_lengths
  step licences licences
  if command -v clang-tidy >/dev/null && [[ -e $root/build/clang/compile_commands.json ]]; then
    step "clang-tidy: today's part of the files, and those changed last" tidy
  else
    skip clang-tidy "no clang-tidy, or nothing configured for clang"
  fi
fi

printf '\n== summary, %d s\n' "$SECONDS"
printf '%s\n' "${results[@]}"
grep -E '^[0-9]+% tests passed' "$root/build/ctest.log" 2>/dev/null | tail -n 1
skips
exit "$failed"
