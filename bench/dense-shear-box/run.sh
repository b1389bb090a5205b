#!/usr/bin/env bash
# Times the dense shear box: a packing is made once, then sheared with one thread and with two, pinned, in turns.
#   run.sh [GRAINS [ROUNDS]]      10000 and 3 unless given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

grains=${1:-10000} rounds=${2:-3}
grit=../../build/bin/grit results=../../results/bench
pack=$results/pack-$grains
if [[ ! -f $pack/packing.txt ]]; then
  side=$(awk "BEGIN {print 14e-3 * ($grains / 10000) ^ (1 / 3)}")
  box=()
  for pointer in /domain/high /bodies/sand/grains/high; do box+=(--set "$pointer=[$side, $side, $side]"); done
  "$grit" run pack.json --out "$pack" --overwrite "${box[@]}" --set "/bodies/sand/grains/count=$grains"
fi
read -r low high < <(awk '/^# cell/ {gsub(",", ""); print "["$3","$4","$5"]", "["$7","$8","$9"]"}' "$pack/packing.txt")
for ((round = 0; round < rounds; ++round)); do
  for threads in 1 2; do
    echo -n "$grains grains, $threads thread(s): "
    taskset -c "0-$((threads - 1))" "$grit" run shear.json --out "$results/shear" --overwrite --quiet --threads "$threads" \
      --set "/domain/low=$low" --set "/domain/high=$high" --set "/bodies/sand/grains/path=$PWD/$pack/packing.txt"
    sed -n 's/.*"particle_steps_per_s": \([0-9.e+]*\).*/\1 particle-steps per second/p' "$results/shear/run.json"
  done
done
