#!/usr/bin/env bash
# Runs the fuzzers of tests/fuzz, two at a time, each from its kept corpus (tests/fuzz/corpus/NAME) and from what earlier runs found on this machine.
#
#   scripts/fuzz.sh BUILD SECONDS [NAME...]     BUILD: a directory made with -DKARCHER_FUZZ=ON; without names, all of them
#
# A finding is an input that crashes, takes more than 10 s, 1 GB in all or 300 MB at once, leaks, or is neither taken nor refused by an InputError. It is left in BUILD/fuzz.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 seconds=$2
shift 2
names=("$@")
if [ ${#names[@]} -eq 0 ]; then
  for corpus in tests/fuzz/corpus/*/; do names+=("$(basename "$corpus")"); done
fi
# MPI of one rank in a container.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OPENBLAS_NUM_THREADS=1

fuzz() {
  local name=$1 directory=$build/fuzz log dictionary=()
  log=$directory/$name.log
  mkdir -p "$directory/$name"
  [ -f "tests/fuzz/${name%%_*}.dict" ] && dictionary=("-dict=tests/fuzz/${name%%_*}.dict")
  if "$build/tests/fuzz/${name}_fuzz" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=300 -use_value_profile=1 -print_final_stats=1 \
    "${dictionary[@]}" -artifact_prefix="$directory/$name-" "$directory/$name" "tests/fuzz/corpus/$name" >"$log" 2>&1; then
    echo "$name: $(sed -n 's/^stat::number_of_executed_units: //p' "$log") inputs, nothing found"
    return
  fi
  local input
  input=$(sed -nE 's/.*Test unit written to (.*)/\1/p' "$log" | head -n 1)
  grep -m 1 -nE 'ERROR: |runtime error: |terminate called|SUMMARY: ' "$log" || tail -n 5 "$log"
  echo "$name: FAILED, see $log. ${input:+Again: $build/tests/fuzz/${name}_fuzz $input. Once it is mended, its text belongs into a test of the room.}"
  return 1
}
export -f fuzz
export build seconds
printf '%s\n' "${names[@]}" | xargs -P 2 -I NAME bash -c 'fuzz NAME'
