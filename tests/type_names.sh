#!/usr/bin/env bash
# Fails where two files of limber/ define a type of one name in namespace limber. Each would build, and a program that
# links both would have whichever the linker meets first; tests/every_header.cpp sees it only where headers define both.
# What is in an anonymous or an inner namespace does not count.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 2
find limber -name '*.h' -o -name '*.cpp' | grep -vE '_test\.cpp$|/testing/' | LC_ALL=C sort | xargs awk '
  FNR == 1 { hidden = 0 }
  /^namespace limber \{/ { next }
  /^namespace / { hidden = 1; next }
  /^}  \/\/ namespace limber$/ { next }
  /^}  \/\/ namespace/ { hidden = 0; next }
  !hidden && /^(struct|class|union|enum|enum class|enum struct) [A-Za-z_0-9]+( final)?( :.*)? \{/ {
    name = $2 == "class" || $2 == "struct" ? $3 : $2
    if (name in file) { print name ": " file[name] " and " FILENAME; failed = 1 } else file[name] = FILENAME
  }
  END { exit failed }'
