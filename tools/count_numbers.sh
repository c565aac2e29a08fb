#!/usr/bin/env bash
# How large the reading and the matching of bodies are, and how many of their numbers say nothing of themselves:
#   tools/count_numbers.sh [FOLDER...]        (limber/character/anatomy and limber/character/matching)
# Lines of sources without tests and without what is generated; named constants without a comment behind them or on the
# line above.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ $# -gt 0 ] || set -- limber/character/anatomy limber/character/matching

files=$(git ls-files --cached --others --exclude-standard "$@" | grep -E '\.(h|cpp)$' | grep -vE '_test\.cpp$|/testing/|/part_weights\.cpp$')
echo "lines: $(cat $files | wc -l)"
awk '
  FNR == 1 { before = "" }
  /constexpr (double|float|int|Index|std::size_t) k[A-Z]/ {
    ++all
    if ($0 !~ /\/\// && before !~ /^ *\/\//) { ++bare; print "  " FILENAME ":" FNR ": " $0 }
  }
  { before = $0 }
  END { printf "named numbers: %d, of which %d say nothing of unit, range or source\n", all, bare }
' $files
