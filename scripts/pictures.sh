#!/usr/bin/env bash
# Draws the pictures of the documentation anew, from runs of a minute each. Needs a build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mkdir -p docs/pictures
for run in quick quick-loose; do
  build/bin/grit run "sims/direct-shear/$run.json" --out "results/pictures/$run" --overwrite
  rsvg-convert --width 1000 "results/pictures/$run/picture.svg" --output "docs/pictures/direct-shear-$run.png"
done
