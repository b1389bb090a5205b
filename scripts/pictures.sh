#!/usr/bin/env bash
# Draws the pictures of the documentation again, from runs of some minutes each. Needs a build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# drawn RUN PICTURE: a run's picture as PNG, 1000 pixels wide if it has the full width.
drawn() { rsvg-convert --zoom 1.1111 "results/pictures/$1" --output "docs/$2.png"; }

mkdir -p docs/pictures docs/gallery
# gallery NAME FILE [OPTION…]: curves and grains of a test, for docs/gallery/README.md.
gallery() {
  local name=$1 file=$2
  shift 2
  build/bin/grit run "$file" --out "results/pictures/$name" --overwrite --threads 1 "$@"
  build/bin/grit report --png "results/pictures/$name"
  drawn "$name/curves.svg" "gallery/$name-curves"
  drawn "$name/grains.svg" "gallery/$name-grains"
}
gallery direct-shear sims/direct-shear/quick.json
gallery triaxial sims/triaxial/quick.json
gallery interface-rn-100 sims/interface-shear/quick-rn-100.json
gallery interface-dl-0240 sims/interface-shear/quick-dl-0240.json
gallery silo-discharge sims/silo-discharge/quick.json
drawn direct-shear/map-strain-strain.svg gallery/direct-shear-strain
drawn direct-shear/force-chains.svg gallery/direct-shear-force-chains
drawn direct-shear/directions-force-chains.svg gallery/direct-shear-directions
drawn silo-discharge/map-flow-velocity.svg gallery/silo-discharge-velocity
drawn silo-discharge/layers.svg gallery/silo-discharge-layers

# Pages, if there is a browser: that of a finished run for the README, and the one that a running simulation serves.
if command -v chromium > /dev/null; then
  # shot URL PICTURE: the page down to its grains.
  shot() {
    PYTHONPATH=tests/report /usr/bin/python3 - "$1" "docs/$2.png" << 'end'
import sys
from browser import GRAINS, Browser, find_chromium

with Browser(find_chromium(), width=1000, height=2400) as browser:
    browser.open(sys.argv[1])
    browser.wait("document.querySelectorAll('figure.chart[data-drawn]').length > 1 && !document.querySelector('.problems')")
    browser.wait(f"{GRAINS}.painted")
    browser.wait("[...document.querySelectorAll('.progress')].every((line) => line.textContent)")
    browser.resize(1000, browser.evaluate("Math.ceil(document.querySelector('figure.grains').getBoundingClientRect().bottom) + 16"))
    browser.screenshot(sys.argv[2])
end
  }
  shot results/pictures/direct-shear/report.html pictures/report
  watched=results/pictures/watched
  rm -rf "$watched" # else its frames exist already
  build/bin/grit run sims/silo-discharge/quick.json --out "$watched" --overwrite --threads 1 --watch 2> "$watched.log" &
  run=$!
  until [[ -e $watched/frames/000018.h5 ]]; do
    kill -0 "$run" # fails if the run has ended
    sleep 1
  done
  kill -STOP "$run" # else it may end while the page is drawn; the page is served by another process
  status=0
  shot "$(grep --only-matching --max-count=1 'http://[0-9.:]*/' "$watched.log")" gallery/watched || status=$?
  kill -CONT "$run"
  kill -INT "$run"
  wait "$run" || true
  ((status == 0))
fi

# Its force chains in ParaView, if installed, by the script of docs/how-to/paraview.md; 256 colours reduce the file to a quarter.
if command -v pvpython > /dev/null && command -v xvfb-run > /dev/null; then
  (
    cd results/pictures
    sed -n '/^```pvpython/,/^```$/{/^```/d; p}' ../../docs/how-to/paraview.md | sed "s@/home/me/results/box@$PWD/direct-shear@" > chains.py
    xvfb-run -a -s '-noreset -screen 0 1280x1024x24' pvpython chains.py
    /usr/bin/python3 -c 'from PIL import Image; Image.open("force-chains.png").convert("RGB").quantize(256, method=1).save("../../docs/pictures/force-chains.png", optimize=True)'
  )
fi
