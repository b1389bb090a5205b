#!/usr/bin/env bash
# Fuzzes the readers of files from strangers (tests/fuzz) with libFuzzer and sanitizers, one on each core, and prints
# a table of targets, runs and findings. Findings stay in build-fuzz/findings/TARGET. Exit status 1 if there are any.
#   fuzz.sh [--markdown] [SECONDS [TARGET…]]     SECONDS for each target, default 60; default: all targets
# --markdown also writes the rows into docs/evidence/reliability.md.
# A finding again: build-fuzz/fuzz/fuzz_TARGET build-fuzz/findings/TARGET/FILE
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

page=
if [[ ${1-} == --markdown ]]; then
  page=docs/evidence/reliability.md
  shift
fi
seconds=${1:-60}
shift || true
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "fuzz: found '$seconds' seconds; usage: fuzz.sh [--markdown] [SECONDS [TARGET…]]" >&2; exit 1; }

cmake --preset fuzz >&2
cmake --build --preset fuzz >&2

folder=build-fuzz
targets=("$@")
if [[ ${#targets[@]} == 0 ]]; then
  for list in "$folder"/fuzz/*.corpora; do targets+=("$(basename "$list" .corpora)"); done
fi

export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1
[[ -d /dev/shm && -w /dev/shm ]] && export TMPDIR=/dev/shm # inputs are written to files

# Runs of libFuzzer until the time is over: it stops at each finding.
fuzz() {
  local target=$1 left=$seconds runs=0 began ended
  mapfile -t corpora < <(grep . "$folder/fuzz/$target.corpora")
  mkdir -p "$folder/corpus/$target" "$folder/findings/$target"
  : > "$folder/findings/$target.log"
  for ((round = 0; round < 50 && left > 0; ++round)); do
    began=$SECONDS
    "$folder/fuzz/fuzz_$target" -max_total_time="$left" -max_len=65536 -timeout=30 -rss_limit_mb=4096 -print_final_stats=1 \
      -artifact_prefix="$folder/findings/$target/" "$folder/corpus/$target" "${corpora[@]}" > "$folder/last.$target.log" 2>&1 || true
    cat "$folder/last.$target.log" >> "$folder/findings/$target.log"
    runs=$((runs + $(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/last.$target.log" | tail -n 1 | grep . || echo 0)))
    ended=$SECONDS
    left=$((left - (ended > began ? ended - began : 1)))
  done
  echo "$runs"
}

# Findings that occur again; others, such as of a child process, are removed.
verified() {
  local target=$1 count=0
  for finding in "$folder/findings/$target"/*; do
    [[ -f $finding ]] || continue
    if "$folder/fuzz/fuzz_$target" -timeout=30 -rss_limit_mb=4096 "$finding" > /dev/null 2>&1; then rm "$finding"; else count=$((count + 1)); fi
  done
  echo "$count"
}

# A row for one target. Status 1 if it has findings.
watched() {
  local target=$1 runs findings
  runs=$(fuzz "$target")
  findings=$(verified "$target")
  printf '%-14s %12s %9s\n' "$target" "$runs" "$findings"
  [[ -z $page ]] || flock "$folder" scripts/tables.py "$page" fuzzing "$target" "$runs" "$findings" "$(awk "BEGIN { printf \"%.2f\", $seconds / 3600 }")"
  [[ $findings == 0 ]]
}

for target in "${targets[@]}"; do
  [[ -x $folder/fuzz/fuzz_$target ]] || { echo "fuzz: there is no target '$target'" >&2; exit 1; }
done
trap 'kill $(jobs -p) 2> /dev/null || true' EXIT
printf '%-14s %12s %9s\n' target runs findings
cores=$(nproc) started=() status=0
for target in "${targets[@]}"; do
  [[ $(jobs -r | wc -l) -lt $cores ]] || wait -n || true
  watched "$target" &
  started+=($!)
done
for job in "${started[@]}"; do wait "$job" || status=1; done
[[ $status == 0 ]] || { echo "fuzz: a target failed, or findings are in $folder/findings: make a test of each" >&2; exit 1; }
