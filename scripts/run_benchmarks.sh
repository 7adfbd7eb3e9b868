#!/usr/bin/env bash
# Runs every benchmark: a table each on stdout, and the figures as build/bench/NAME.json.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mkdir -p build/bench
for program in build/release/tests/bench/*_bench; do
  name=$(basename "$program" _bench)
  printf '\n=== %s\n' "$name"
  if [[ $name == core ]]; then # Google Benchmark's own options
    "$program" --benchmark_out="build/bench/$name.json" --benchmark_out_format=json
  else
    "$program" --json "build/bench/$name.json"
  fi
done
printf '\nAs JSON: build/bench/*.json\n'
