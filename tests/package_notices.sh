#!/usr/bin/env bash
# package_notices.sh PACKAGES_FOLDER RELEASE_BUILD WORK_FOLDER: every package carries the notice of each part that is compiled into it, with the
# licence's own words, and of each shared library that it carries. Ends with "N passed, N failed".
set -uo pipefail

packages=$(cd "$1" && pwd) build=$2
rm -rf "$3"
mkdir -p "$3"/{program,library,portable,wheel,npm,addon}
work=$(cd "$3" && pwd)
passed=0 failed=0

# told <file> <words>...: each of them is in it.
told() {
  local file=$1 words
  shift
  for words in "$@"; do
    if grep -qF -- "$words" "$file" 2>/dev/null; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: ${file#"$work"/} lacks $words"; fi
  done
}

# Who holds the rights, and a line of the licence itself.
eigen=("Gael Guennebaud" "Mozilla Public License Version 2.0") json=("Niels Lohmann" "Permission is hereby granted, free of charge")
fmt=("Victor Zverovich") fast_float=("Antoine Pitrou") cli=("University of Cincinnati" "Redistribution and use in source and binary forms")
engine=("${eigen[@]}" "${json[@]}" "${fmt[@]}" "${fast_float[@]}" "Rich Felker" "LLVM Exceptions")
page=("three.js authors" "Arjun Barrett" "Juan Mellado" "Arseny Kapoulkine" "Google Inc" "Yuji Hirose" "Kentaro Fukuchi" "${engine[@]}")
library=("${eigen[@]}" "${json[@]}" "${fmt[@]}" "${fast_float[@]}")
program=("${library[@]}" "${cli[@]}")
! grep -q '^LIMBER_STUDIO:BOOL=ON' "$build/CMakeCache.txt" || program+=("${page[@]}")
python=("${program[@]}" "Wenzel Jakob")
own=("Apache License" "END OF TERMS AND CONDITIONS")

dpkg-deb -x "$packages"/limber_*.deb "$work/program"
dpkg-deb -x "$packages"/liblimber-dev_*.deb "$work/library"
tar -xzf "$packages"/limber-*-linux-*.tar.gz -C "$work/portable" --strip-components=1
/usr/bin/python3 -m zipfile -e "$packages"/limber-*.whl "$work/wheel"
/usr/bin/python3 -m zipfile -e "$packages"/limber-blender-*.zip "$work/addon"
told "$work/program/usr/share/doc/limber/NOTICES" "${program[@]}"
told "$work/program/usr/share/doc/limber/copyright" "Apache-2.0" "NOTICES beside this one"
told "$work/library/usr/share/doc/liblimber-dev/NOTICES" "${library[@]}"
told "$work/portable/share/doc/limber/NOTICES" "${program[@]}"
told "$work/portable/share/doc/limber/LICENSE" "${own[@]}"
info=$(echo "$work"/wheel/limber-*.dist-info)
told "$info/NOTICES" "${python[@]}"
told "$info/LICENSE" "${own[@]}"
told "$work/addon/limber/LICENSE" "${own[@]}" # of others there is nothing in it
for npm in "$packages"/limber-[0-9]*.tgz; do
  [ -f "$npm" ] || continue # no WebAssembly was built
  tar -xzf "$npm" -C "$work/npm" --strip-components=1
  told "$work/npm/NOTICES" "${engine[@]}"
  told "$work/npm/LICENSE" "${own[@]}"
done
# Shared libraries: as many notices as they are packages, each with a word of rights.
for place in "$work/portable/lib $work/portable/share/doc/limber/libraries" "$work/wheel/limber/lib $info/libraries"; do
  read -r libraries notices <<<"$place"
  for library in "$libraries"/*.so*; do
    name=$(basename "$library")
    owner=$(dpkg-query -S "*/$name" | head -n 1 | cut -d: -f1)
    told "$notices/$owner.txt" opyright
  done
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
