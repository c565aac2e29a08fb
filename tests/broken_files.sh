#!/usr/bin/env bash
# Feeds faulty files to the real program. Each must end, within memory and time limits, in one line of error with a
# non-zero exit and no file left, or in a result that the program itself reads again.
#
#   tests/broken_files.sh PROGRAM OUTPUT_FOLDER [FOLDER_OF_FAULTY_FILES]
#
# Besides the folder's files it tries cut and patched copies of a sample. Ends with "N passed, N failed".
set -uo pipefail

program=$1 output=$2 folder=${3:-}
export program memory_kb=$((2 * 1024 * 1024)) # address space, threads' stacks included
export seconds=20

# limited ERRORS ARGUMENT...: the program under limits; its standard error goes to the file ERRORS.
limited() {
  (
    ulimit -v $memory_kb -c 0
    exec timeout -k 1 $seconds "$program" "${@:2}" </dev/null >/dev/null 2>"$1"
  )
}

# check FILE NAME: the name tells files of the same name in different folders apart. What is read at all is rigged both
# ways.
check() {
  check_rig "$1" "$2" --handles 6
  [ ! -e "$output/$2.glb" ] || check_rig "$1" "$2.template" --template humanoid
}

# check_rig FILE NAME OPTIONS...: a line that says "passed", or what failed.
check_rig() {
  local file=$1 result=$output/$2.glb errors=$output/errors/$2 code
  shift 2
  limited "$errors" rig "$file" "$@" --replace-rig --quiet -o "$result"
  code=$?
  if [ $code -ge 124 ]; then
    echo "FAILED $file: the program was ended with code $code (time, memory or a crash): $(head -c 300 "$errors")"
  elif [ $code -ne 0 ] && [ "$(wc -l <"$errors")" -ne 1 ]; then
    echo "FAILED $file: not one line of error: $(head -c 300 "$errors")"
  elif [ $code -ne 0 ] && compgen -G "$result*" >/dev/null; then
    echo "FAILED $file: an error, but a file was left: $(compgen -G "$result*" | tr '\n' ' ')"
  elif [ $code -eq 0 ] && ! limited "$errors" info "$result"; then
    echo "FAILED $file: the result is not read again: $(head -c 300 "$errors")"
  else
    [ $code -ne 0 ] || echo "$file" >"$result.source"
    echo passed
  fi
}
export -f limited check check_rig

# Makes the file's first bytes only, and copies with a few bytes overwritten, at places spread over it; names each twice,
# as check takes them.
damaged_copies() {
  local whole=$1 size copy at step i
  size=$(stat -c %s "$whole")
  for i in $(seq 0 24); do
    copy=$output/cut_$i.damaged
    head -c $((size * i / 25)) "$whole" >"$copy"
    printf '%s\0' "$copy" "cut_$i"
  done
  # The JSON comes first; damage there is the more interesting.
  for i in $(seq 0 59); do
    step=$((i < 40 ? 97 : size / 61))
    at=$((i * step % (size - 4)))
    copy=$output/patched_$i.damaged
    cp "$whole" "$copy"
    case $((i % 4)) in
      0) printf '\xff\xff\xff\xff' ;;
      1) printf '\x00' ;;
      2) printf '9' ;;
      3) printf '"' ;;
    esac | dd of="$copy" bs=1 seek="$at" conv=notrunc status=none
    printf '%s\0' "$copy" "patched_$i"
  done
}

faulty_files() {
  [ -n "$folder" ] || return 0
  local file name
  while IFS= read -r file; do
    name=${file#"$folder"/}
    printf '%s\0' "$file" "${name//\//__}"
  done < <(find "$folder" -type f | grep -iE '\.(glb|gltf|obj|ply|stl|off|fbx|dae|bvh)$' | LC_ALL=C sort)
}

rm -rf "$output"
mkdir -p "$output/errors"
output=$(cd "$output" && pwd)
export output
"$program" sample stool -o "$output/whole.glb" --quiet || exit 1
{ damaged_copies "$output/whole.glb" && faulty_files; } |
  xargs -0 -n 2 -P "$(nproc)" bash -c 'check "$@"' - >"$output/results" || exit 1
rm -rf "$output/errors"

grep -v '^passed$' "$output/results"
passed=$(grep -c '^passed$' "$output/results") failed=$(grep -c '^FAILED ' "$output/results")
rm "$output/results"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
