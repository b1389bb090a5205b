#!/usr/bin/env bash
# Installs the dependencies, builds everything and runs all tests; CTest's summary is the last output.
#   test.sh [ARGUMENTS OF CTEST…]      e.g. test.sh -R loader
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh
cmake --preset release -DGRIT_BATCH_TESTS=ON -DCMAKE_UNITY_BUILD=ON
cmake --build --preset release
exec ctest --preset release -j"$(nproc)" "$@"
