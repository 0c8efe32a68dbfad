#!/bin/sh
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Runs every libFuzzer program of a build for some seconds, two at a time, from the corpus:
#   tests/fuzz/targets/run.sh build/fuzz [SECONDS] [FOLDER]
# What it finds stays in FOLDER (fuzz_found): the input that failed, new inputs, and the log of each target.
# Exit code 1: a fault was found.
build=$1
seconds=${2:-60}
found=${3:-fuzz_found}
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$found"
run_one() {
  target=$1
  mkdir -p "$found/$target"
  "$build/tests/fuzz/targets/fuzz_$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=3000 \
    -max_len=32768 -print_final_stats=1 -artifact_prefix="$found/$target-" "$found/$target" \
    "$here/corpus/$target" > "$found/$target.log" 2>&1
  code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$found/$target.log")
  echo "$target: exit code $code, ${runs:-?} inputs"
  [ $code -eq 0 ] || echo "$target" >> "$found/faults"
}
rm -f "$found/faults"
running=0
for folder in "$here"/corpus/*/; do
  run_one "$(basename "$folder")" &
  running=$((running + 1))
  [ $((running % 2)) -eq 0 ] && wait
done
wait
[ ! -f "$found/faults" ]
