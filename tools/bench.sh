#!/usr/bin/env bash
# Runs the benchmarks and prints the table. Called by ./dev bench [FILTER], with the program and limber_bench built.
set -euo pipefail

filter=${1:-.}
families=$(build/release/limber_bench --benchmark_list_tests | grep -E -- "$filter" | cut -d/ -f1 | awk '!seen[$0]++')
[ -n "$families" ] || { echo "no benchmark has a name like $filter" >&2; exit 1; }

# Each family in a process of its own: a heap that one has left behind is no part of another's figures.
rm -rf build/bench
mkdir -p build/bench
for family in $families; do
  echo "$family ..." >&2
  names=$(build/release/limber_bench --benchmark_list_tests | grep -E "^$family(/|$)" | grep -E -- "$filter" | paste -sd'|')
  build/release/limber_bench --benchmark_filter="^($names)\$" --benchmark_out="build/bench/$family.json" \
    --benchmark_out_format=json </dev/null >build/bench/log 2>&1 || { tail -n 20 build/bench/log >&2; exit 1; }
  results+=("build/bench/$family.json")
done
node tools/bench_table.mjs "${results[@]}"
