#!/usr/bin/env bash
# Builds what a run needs, shears a small box of sand, and says where to look. Replaces the results of an earlier demo.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

results=results/demo
scripts/install-deps.sh
cmake --preset release
cmake --build --preset release --target grit_app grit_plugins

rm -rf "$results"
build/bin/grit run sims/direct-shear/quick.json --out "$results"

echo
echo "Results: $PWD/$results"
echo "Page:    $PWD/$results/report.html"
find "$results" -type f \( -name '*.png' -o -name '*.svg' \) -printf 'Picture: %p\n' | sort | sed "s@: @: $PWD/@"
