#!/usr/bin/env bash
# make.sh WASM_BUILD_FOLDER LIMBER OUTPUT_FOLDER: the npm package limber-VERSION.tgz. Called by ./dev package.
set -euo pipefail
wasm=$(realpath "$1") limber=$(realpath "$2")
mkdir -p "$3"
output=$(realpath "$3")
cd "$(dirname "$0")"
work=$wasm/npm
rm -rf "$work"
mkdir -p "$work/dist"
cp -r package.json README.md bin ../../LICENSE "$work"
../../tools/notices.sh npm "" "$wasm" >"$work/NOTICES"
cp -r index.mjs index.d.ts engine_code.mjs worker ../wasm/limber.mjs "$wasm"/limber_engine.mjs "$wasm"/limber_engine.wasm \
  ../../limber/reading/data/shapes.lrd "$work/dist"
"$limber" session types >"$work/dist/commands.d.ts"
# The engine's types are in its comments; its commands are those of the C++.
sed -i -E "s#@typedef \{\{ do: string, .*\}\} Command .*#@typedef {import('./commands.js').Command} Command#" "$work/dist/limber.mjs"
echo "/** @typedef {Awaited<ReturnType<typeof loadLimber>>} Limber */" >>"$work/dist/limber.mjs"
../../apps/studio/node_modules/.bin/tsc --declaration --emitDeclarationOnly --allowJs --skipLibCheck --target es2022 --module nodenext \
  --moduleResolution nodenext --outDir "$work/dist" "$work/dist/limber.mjs"
rm -f "$work/dist/limber_engine.d.mts"
(cd "$work" && npm pack --silent --pack-destination "$output" >/dev/null)
