#!/usr/bin/env bash
# run.sh WORK_FOLDER: the tests of the module in PYTHONPATH, then the tour. Ends with "N passed, N failed".
set -uo pipefail
mkdir -p "$1"
here=$(cd "$(dirname "$0")" && pwd) log=$1/tests.log failed=0
/usr/bin/python3 "$here/test_limber.py" >"$log" 2>&1 || { failed=1; cat "$log"; }
ran=$(sed -nE 's/^Ran ([0-9]+) tests? in .*/\1/p' "$log")
/usr/bin/python3 "$here/../tour/tour.py" "$1" >"$1/tour.log" 2>&1 || { failed=$((failed + 1)); cat "$1/tour.log"; }
echo "$((${ran:-0} + 1 - failed)) passed, $failed failed"
[ $failed = 0 ] && [ -n "$ran" ]
