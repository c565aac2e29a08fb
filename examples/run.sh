#!/usr/bin/env bash
# run.sh EXAMPLES_BUILD_FOLDER LIMBER WORK_FOLDER [PICTURES]: runs each example on models that limber makes; with a fourth word also draws
# the pictures of their pages. Ends with "N passed, N failed".
set -uo pipefail
examples=$(realpath "$1") limber=$(realpath "$2") draws=${4:-}
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$3/motions"
cd "$3"
passed=0 failed=0

# tried <words that it prints> <example> <arguments...>
tried() {
  local words=$1 said
  shift
  if said=$("$examples/$1" "${@:2}" 2>said.log) && grep -qE "$words" <<<"$said"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $*: $said $(tail -n 1 said.log)"
  fi
}
drawn() { [ -z "$draws" ] || "$limber" preview "$2" "${@:3}" -o "$here/$1/picture.png" --quiet; }

"$limber" sample biped -o person.glb --quiet
"$limber" sample quadruped -o fox.glb --quiet
for motion in walk wave run; do "$limber" sample $motion -o motions/$motion.bvh --quiet; done

tried '^22 joints, humanoid' rig_a_file person.glb rigged.glb
drawn rig_a_file rigged.glb --show bones --size 320x320
tried '^leftHand: 0\.0 mm left' pose_it rigged.glb posed.glb statue.obj
drawn pose_it statue.obj --size 320x320
tried '^walk: [0-9]+ frames, 2[0-9] joints' retarget_a_folder rigged.glb motions moving.glb
drawn retarget_a_folder moving.glb --clip walk --frames 6 --size 120x160
tried '^6 joints, 0 vertices' own_rigger fox.glb spine.glb
drawn own_rigger spine.glb --show weights --size 320x320
"$limber" rig fox.glb --template quadruped -o fox_rigged.glb --quiet
tried '^joint to joint +[0-9]' evaluate spine.glb fox_rigged.glb
drawn evaluate spine.glb --show stretch --worst 3 --size 320x320
tried '^199 frames, the highest point at 1\.[0-9]+ m' live_motion rigged.glb motions/walk.bvh
drawn live_motion moving.glb --clip walk --time 0.4 --size 320x320
# Files that cannot be read: one line, and nothing is written.
for example in rig_a_file own_rigger; do
  if "$examples/$example" nothing.glb out.glb 2>said.log || [ -e out.glb ] || [ "$(wc -l <said.log)" != 1 ]; then
    failed=$((failed + 1)) && echo "FAILED: $example on a file that is not there"
  else
    passed=$((passed + 1))
  fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
