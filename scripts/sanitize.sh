#!/usr/bin/env bash
# Finds errors of memory, undefined behaviour and data races: builds and runs the whole test suite with sanitizers, or a
# short run, its continuation and its report under valgrind. Needs scripts/install-deps.sh --sanitizers.
#   sanitize.sh [--markdown] address|thread [ROOM…]
#   sanitize.sh [--markdown] valgrind
# ROOM: what names of tests begin with, up to the colon, e.g. resume or contacts/jkr; default: all tests. The whole suite
# takes some hours on two cores. If it was stopped, and nothing has been built since, the same command goes on with the
# tests that have not passed yet.
# --markdown also writes a row into docs/evidence/reliability.md, also for some rooms only.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

page=
if [[ ${1-} == --markdown ]]; then
  page=docs/evidence/reliability.md
  shift
fi
record() {
  [[ -z $page ]] || scripts/tables.py "$page" sanitizers "$1" "$2" "$3" "$(awk "BEGIN { printf \"%.2f\", $SECONDS / 3600 }")"
}

case ${1-} in
  address | thread)
    kind=$1 preset=sanitize-$1
    shift
    cmake --preset "$preset" -DGRIT_BATCH_TESTS=ON -DCMAKE_UNITY_BUILD=ON
    rooms=$* selection=(${*:+-R "^(${rooms// /|}): "})
    built=build-$preset log=$built/ctest.log passed=$built/passed spent=$built/seconds command="ctest $rooms"
    cmake --build --preset "$preset" | tee "$built/build.log"
    if grep -q "no work to do" "$built/build.log" && [[ "$(head -n 1 "$log" 2> /dev/null)" == "$command" ]] && ! grep -q "tests passed," "$log"; then
      #  12/4967 Test   #13: input: Units.… .....   Passed    0.12 sec
      sed -nE 's/^ *[0-9]+\/[0-9]+ Test +#([0-9]+): .*( Passed|\*\*\*Skipped) +[0-9.]+ sec.*/\1/p' "$log" >> "$passed"
    else
      : > "$passed"
      echo 0 > "$spent"
    fi
    before=$(cat "$spent")
    trap 'echo $((before + SECONDS)) > "$spent"' EXIT
    echo "$command" > "$log"
    all=$(ctest --preset "$preset" "${selection[@]}" -N | sed -nE 's/^ *Test +#([0-9]+): .*/\1/p')
    [[ -n $all ]] || { echo "sanitize: no test is named '$rooms: …'; 'ctest --preset $preset -N' lists all" >&2; exit 1; }
    left=$(grep -vxFf "$passed" <<< "$all" | paste -sd , || true)
    echo "sanitize: $(wc -l <<< "$all") tests, $(sort -u "$passed" | wc -l) have passed before"
    echo "0,0,1,$left" > "$built/left"
    status=0
    ctest --preset "$preset" -j"$(nproc)" "${selection[@]}" -I "$built/left" | tee -a "$log" || status=$?
    grep -q "tests passed," "$log" || exit "$status" # stopped
    # 97% tests passed, 3 tests failed out of 100
    failed=$(sed -nE 's/.*tests passed, ([0-9]+) tests failed out of.*/\1/p' "$log")
    SECONDS=$((before + SECONDS)) before=0
    record "$kind${rooms:+: $rooms}" "$(wc -l <<< "$all") tests, $(git describe --always --dirty)" "$failed"
    exit "$status"
    ;;
  valgrind)
    cmake --preset valgrind
    cmake --build --preset valgrind
    folder=$(mktemp -d)
    trap 'rm -r "$folder"' EXIT
    watched() {
      echo "valgrind: grit $*"
      valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite build-valgrind/bin/grit "$@" > "$folder/log" ||
        { cat "$folder/log"; echo "valgrind: grit $* failed" >&2; exit 1; }
    }
    sets=(--set /stages/1/until/value=500 --set '/output={"frames": {"every_steps": 100}}'
          --set '/walls={"floor": {"type": "plane", "point": [0, 0, "4.4 mm"], "normal": [0, 0, 1], "material": "sand"}}'
          --set '/domain={"low": [0, 0, 0], "high": ["10 mm", "10 mm", "10 mm"], "periodic": [true, true, false]}'
          --set '/probes={"packing": {"type": "packing", "every_steps": 50}, "chains": {"type": "force-chains", "every_steps": 50}}'
          --set '/probes/energy={"type": "energy", "every_steps": 50}')
    watched check bench/scenes/tiny.json "${sets[@]}"
    watched run bench/scenes/tiny.json --out "$folder/run" --threads 2 "${sets[@]}"
    watched report "$folder/run"
    echo "valgrind: no errors"
    record valgrind "check, run and report of a short run" 0
    ;;
  *)
    echo "sanitize: found '${1-}'; usage: sanitize.sh [--markdown] address|thread [ROOM…] | valgrind" >&2
    exit 1
    ;;
esac
