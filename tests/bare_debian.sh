#!/usr/bin/env bash
# bare_debian.sh PACKAGES_FOLDER WORK_FOLDER: a Debian 12 with nothing on it runs the program out of the .tar.gz, then installs the .deb
# with apt, then the library's, and builds the examples against that, and the wheel. All give the same bytes.
# Needs mmdebstrap and root. Ends with "N passed, N failed"; where no such system can be made, with code 77 and why.
set -uo pipefail

packages=$(cd "$1" && pwd)
mkdir -p "$2"
work=$(cd "$2" && pwd)
passed=0 failed=0
examples=$(cd "$(dirname "$0")/../examples" && pwd)

cat >"$work/inside.sh" <<'INSIDE'
set -e
export DEBIAN_FRONTEND=noninteractive
cd /limber
say() { echo "bare: $*"; }
say it stands
mkdir portable && tar -xzf ./*.tar.gz -C portable --strip-components=1
try() {
  local limber=$1 name=$2
  $limber --version
  $limber sample biped --quiet -o model.glb
  $limber rig model.glb --template humanoid --quiet -o $name.glb
  $limber preview $name.glb --quiet -o $name.png
}
for name in fmt assimp draco tbb zip meshoptimizer; do
  if ls /usr/lib/*/lib$name.so* 2>/dev/null; then exit 1; fi # it is no bare system
done
try portable/bin/limber portable && say the tar.gz runs
# The mirror of the machine itself may be gone once the system stands, but not what mmdebstrap was told to fetch.
apt-get -q -y install ./limber_*.deb </dev/null && try limber installed && say the deb installs
cmp portable.glb installed.glb && say both give the same bytes
zcat /usr/share/man/man1/limber-rig.1.gz | grep -q skinning && say the manual is there
bash -c '. /usr/share/bash-completion/completions/limber; COMP_WORDS=(limber rig --skin); COMP_CWORD=2; _limber; [ "${COMPREPLY[*]}" = --skinning ]' &&
  say bash completes an option
apt-get -q -y install --no-install-recommends python3-venv python3-numpy </dev/null
python3 -m venv --system-site-packages venv && venv/bin/pip install --no-index ./*.whl
apt-get -q -y purge limber >/dev/null </dev/null && apt-get -q -y autoremove --purge >/dev/null </dev/null
if ls /usr/lib/*/libassimp.so* /usr/lib/*/libfmt.so* 2>/dev/null; then exit 1; fi
venv/bin/python - <<'PYTHON'
import limber
model = limber.read("model.glb")
model.rig(template="humanoid")
model.write("wheel.glb")
PYTHON
cmp portable.glb wheel.glb && [ "$(venv/bin/python -m limber --version)" = "$(portable/bin/limber --version)" ] && say the wheel gives them, too
apt-get -q -y install --no-install-recommends cmake ninja-build g++ ./liblimber-dev_*.deb </dev/null
cmake -S examples -B build -G Ninja && cmake --build build && examples/run.sh build portable/bin/limber files && say the examples build against the library and run
INSIDE

rm -rf "$work/files" # of another version there may be others
mkdir -p "$work/files"
export work examples # for the hook
cp "$packages"/*.deb "$packages"/*.tar.gz "$packages"/*.whl "$work/files"
mmdebstrap --variant=apt --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
  --customize-hook='mkdir "$1/limber" && cp -r "$work/files/." "$work/inside.sh" "$examples" "$1/limber"' \
  --customize-hook='chroot "$1" env -u CMAKE_CXX_COMPILER_LAUNCHER bash /limber/inside.sh' \
  bookworm /dev/null >"$work/bare.log" 2>&1 </dev/null
if ! grep -q '^bare: it stands$' "$work/bare.log"; then
  grep -E '^E: ' "$work/bare.log" | head -n 1
  exit 77
fi
for said in "the tar.gz runs" "the deb installs" "both give the same bytes" "the manual is there" "bash completes an option" \
  "the wheel gives them, too" \
  "the examples build against the library and run"; do
  if grep -q "^bare: $said$" "$work/bare.log"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $said"; fi
done
[ $failed = 0 ] || tail -n 40 "$work/bare.log"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
