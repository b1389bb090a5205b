#!/usr/bin/env bash
# Builds what one direct shear test needs, shears a small box of sand, and prints the paths of the results. Replaces the results
# of an earlier demo. The build is in build-demo and does not affect build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

results=results/demo
scripts/install-deps.sh --run
cmake --preset demo
cmake --build --preset demo

rm -rf "$results"
build-demo/bin/grit run sims/direct-shear/demo.json --out "$results"

echo
echo "Results: $PWD/$results"
echo "Page:    $PWD/$results/report.html"
find "$results" -type f \( -name '*.png' -o -name '*.svg' \) -printf 'Picture: %p\n' | sort | sed "s@: @: $PWD/@"
