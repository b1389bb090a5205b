#!/usr/bin/env bash
# Builds what one test needs, shears a small box of sand, and prints where the results are. Replaces those of an earlier demo.
# The build lies in build-demo and does not touch build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

results=results/demo
scripts/install-deps.sh --run
cmake --preset demo
cmake --build --preset demo

rm -rf "$results"
build-demo/bin/grit run sims/direct-shear/quick.json --out "$results"

echo
echo "Results: $PWD/$results"
echo "Page:    $PWD/$results/report.html"
find "$results" -type f \( -name '*.png' -o -name '*.svg' \) -printf 'Picture: %p\n' | sort | sed "s@: @: $PWD/@"
