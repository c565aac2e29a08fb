#!/bin/bash
# A batch in shards by GNU parallel, on this machine or on those of --sshlogin (docs/cluster.md):
#
#   limber_parallel.sh PLAN OUT SHARDS [OPTION OF PARALLEL...]
#
# Started again, it goes on: outputs and records say what is done, not parallel's own log, which counts by number alone.
# Ends with 0 where all is done, 1 where entries failed, 4 where a shard did not come to its end.
set -uo pipefail
plan=$(realpath -- "$1") out=$(realpath -m -- "$2") shards=$3 # seen from elsewhere, too: another machine starts at home
shift 3
limber=${LIMBER:-limber}
# Entries that failed (1) are no failure of their shard: the sum tells them.
seq "$shards" | parallel --quote --will-cite --jobs "${LIMBER_SHARDS_AT_ONCE:-$(nproc)}" --line-buffer "$@" \
  sh -c '"$@"; code=$?; [ $code != 1 ] || code=0; exit $code' sh \
  "$limber" batch "$plan" -o "$out" --shard "{}/$shards" --jobs 1 --quiet
unended=$?
"$limber" batch status "$out" --merge "$out.records.jsonl"
sum=$?
[ $unended = 0 ] && exit $sum
echo "limber_parallel.sh: not every shard came to its end: what they said of it stands above" >&2
exit 4
