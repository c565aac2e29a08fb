#!/usr/bin/env bash
# Feeds faulty files to the real program. Each must end, within memory and time limits, in one line of error with a
# non-zero exit and no file left, or in a result that the program itself reads again.
#
#   tests/broken_files.sh PROGRAM OUTPUT_FOLDER [FOLDER_OF_FAULTY_FILES]
#
# Besides the folder's files it tries cut and patched copies of a sample. Ends with "N passed, N failed".
set -uo pipefail

program=$1 output=$2 folder=${3:-}
memory_kb=$((2 * 1024 * 1024)) # address space, threads' stacks included
seconds=20
passed=0 failed=0

fail() {
  echo "FAILED $1: $2"
  failed=$((failed + 1))
}

# The program on one file, under limits; its standard error goes to $output/stderr.
limited() {
  (
    ulimit -v $memory_kb -c 0
    exec timeout -k 1 $seconds "$program" "$@" </dev/null >/dev/null 2>"$output/stderr"
  )
}

# check FILE NAME: the name tells files of the same name in different folders apart. What is read at all is rigged both
# ways.
check() {
  check_rig "$1" "$2" --handles 6
  [ ! -e "$output/$2.glb" ] || check_rig "$1" "$2.template" --template humanoid
}

# check_rig FILE NAME OPTIONS...
check_rig() {
  local file=$1 result=$output/$2.glb code
  shift 2
  limited rig "$file" "$@" --replace-rig --quiet -o "$result"
  code=$?
  if [ $code -ge 124 ]; then
    fail "$file" "the program was ended with code $code (time, memory or a crash): $(head -c 300 "$output/stderr")"
  elif [ $code -ne 0 ] && [ "$(wc -l <"$output/stderr")" -ne 1 ]; then
    fail "$file" "not one line of error: $(head -c 300 "$output/stderr")"
  elif [ $code -ne 0 ] && compgen -G "$result*" >/dev/null; then
    fail "$file" "an error, but a file was left: $(compgen -G "$result*" | tr '\n' ' ')"
  elif [ $code -eq 0 ] && ! limited info "$result"; then
    fail "$file" "the result is not read again: $(head -c 300 "$output/stderr")"
  else
    [ $code -ne 0 ] || echo "$file" >"$result.source"
    passed=$((passed + 1))
  fi
}

# The file's first bytes only, and copies with a few bytes overwritten, at places spread over it.
check_damaged_copies() {
  local whole=$1 size copy at step i
  size=$(stat -c %s "$whole")
  for i in $(seq 0 24); do
    copy=$output/cut_$i.damaged
    head -c $((size * i / 25)) "$whole" >"$copy"
    check "$copy" "cut_$i"
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
    check "$copy" "patched_$i"
  done
}

rm -rf "$output"
mkdir -p "$output"
output=$(cd "$output" && pwd)
"$program" sample stool -o "$output/whole.glb" --quiet || exit 1
check_damaged_copies "$output/whole.glb"

if [ -n "$folder" ]; then
  while IFS= read -r file; do
    name=${file#"$folder"/}
    check "$file" "${name//\//__}"
  done < <(find "$folder" -type f | grep -iE '\.(glb|gltf|obj|ply|stl|off|fbx|dae|bvh)$' | LC_ALL=C sort)
fi

rm -f "$output/stderr"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
