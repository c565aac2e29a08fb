#!/usr/bin/env bash
# run.sh ADDON.zip PROGRAM WORK_FOLDER [NPM_PACKAGE.tgz]: the add-on's tests in a Blender with settings of its own, without a window
# and in one; without a window once more with nothing but Node and the npm package, where there is one and Node is new enough.
# Ends with "N passed, N failed".
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd) addon=$(realpath "$1") program=$(realpath "$2")
mkdir -p "$3"
work=$(cd "$3" && pwd)
rm -rf "$work"/{scripts,config,temporary,package}
mkdir -p "$work"/{scripts,config,temporary}
export BLENDER_USER_SCRIPTS=$work/scripts BLENDER_USER_CONFIG=$work/config TMPDIR=$work/temporary
passed=0 failed=0

# tried <log> <command...>: its last counts are added; without any it failed.
tried() {
  local log=$1
  shift
  timeout 300 "$@" </dev/null >"$log" 2>&1
  if [[ $(grep -E '^[0-9]+ passed, [0-9]+ failed$' "$log" | tail -n 1) =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    passed=$((passed + BASH_REMATCH[1])) failed=$((failed + BASH_REMATCH[2]))
    [ "${BASH_REMATCH[2]}" = 0 ] || grep -vE '^(Info|Error):' "$log"
  else
    failed=$((failed + 1))
    tail -n 40 "$log"
  fi
}

tried "$work/background.log" blender --background --factory-startup --python-exit-code 1 --python "$here/test_addon.py" -- "$addon" "$program" "$work"
grep -E 'vertices: limber|made anew' "$work/background.log"
if [ -f "${4:-}" ] && [ "$(node -p 'process.versions.node.split(".")[0] >= 20' 2>/dev/null)" = true ]; then
  tar -xzf "$4" -C "$work" # one folder, package
  tried "$work/node.log" blender --background --factory-startup --python-exit-code 1 --python "$here/test_addon.py" -- "$addon" "$program" "$work/node" "$work/package"
  grep -E 'vertices: limber' "$work/node.log" | sed 's/^/in Node: /'
else
  echo "no npm package or no Node 20 here: the add-on is not tried with them"
fi
tried "$work/window.log" xvfb-run -a -s "-screen 0 1280x720x24" blender --no-window-focus -noaudio --factory-startup --enable-event-simulate \
  --python "$here/test_window.py" -- "$addon" "$program" "$work"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
