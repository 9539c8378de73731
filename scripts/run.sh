#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/run.sh ARGS...: runs "h2mc ARGS...". Installs what is missing and builds first, where that is needed; works
# from any folder, and relative paths mean the caller's folder.
set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." >/dev/null && pwd)
source "$root/scripts/lib.sh"

ensure_packages build
build release h2mc
exec "$root/build/release/h2mc" "$@"
