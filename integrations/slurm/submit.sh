#!/bin/bash
# Submits a batch as an array of so many tasks, and the merge behind it; prints the two jobs' numbers.
#
#   submit.sh PLAN OUT TASKS [OPTION OF SBATCH...]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
plan=$1 out=$2 tasks=$3
shift 3
array=$(sbatch --parsable --array="1-$tasks" "$@" "$here/limber_batch.sbatch" "$plan" "$out")
merge=$(sbatch --parsable --dependency="afterany:$array" "$here/limber_merge.sbatch" "$out" "$array")
echo "$array $merge"
