#!/bin/bash
# A batch in shards by GNU parallel, on this machine or on those of --sshlogin (docs/cluster.md):
#
#   limber_parallel.sh PLAN OUT SHARDS [OPTION OF PARALLEL...]
#
# Started again, it goes on: outputs and records say what is done, not parallel's own log, which counts by number alone.
set -uo pipefail
plan=$(realpath -- "$1") out=$(realpath -m -- "$2") shards=$3 # seen from elsewhere, too: another machine starts at home
shift 3
limber=${LIMBER:-limber}
seq "$shards" | parallel --quote --will-cite --jobs "${LIMBER_SHARDS_AT_ONCE:-$(nproc)}" --line-buffer "$@" \
  "$limber" batch "$plan" -o "$out" --shard "{}/$shards" --jobs 1 --quiet
"$limber" batch status "$out" --merge "$out.records.jsonl"
