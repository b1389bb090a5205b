#!/usr/bin/env bash
# Installs the dependencies, builds everything and runs all tests; CTest's summary is the last output.
#   test.sh [ARGUMENTS OF CTEST…]      e.g. test.sh -R loader
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh
cmake --preset release -DGRIT_BATCH_TESTS=ON -DCMAKE_UNITY_BUILD=ON
cmake --build --preset release

# Tests write thousands of small files and wait for the disk: their temporary folder is in memory where there is room, and
# programs may run there.
memory=/dev/shm
if [[ -z ${TMPDIR-} && -w $memory ]] && (($(df --output=avail -BM "$memory" | tail -n 1 | tr -dc 0-9) >= 4096)); then
  folder=$(mktemp -d "$memory/grit-tests.XXXXXX")
  trap 'rm -rf "$folder"' EXIT
  cp /bin/true "$folder"
  if "$folder/true" 2> /dev/null; then export TMPDIR=$folder; fi
fi
ctest --preset release -j"$(nproc)" "$@"
