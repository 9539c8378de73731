#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/soak.sh [MUTATIONS] [--scene NAME]... [--json FILE]: the soak test. Makes so many mutations (default 1e9),
# half of them on the scenes in scenes/ and half on their stress variations, and prints a table of what was met:
# contributions and pixels that are not finite, pixels below 0, memory that grows. Exit code 1 where there was any. 1e9
# takes about two hours on two cores.
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"

case ${1-} in -h | --help) sed -n '2,/^set/{/^set/d;/SPDX/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;; esac
ensure_packages build
command -v python3 >/dev/null || { say "python3 is missing"; exit 2; }
build release h2mc
exec python3 "$root/scripts/soak.py" --program "$root/build/release/h2mc" "$@"
