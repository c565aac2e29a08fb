# Building the engine as WebAssembly and the page on it. Sourced by ./dev, which has configure and compile.

build_wasm() {
  export NODE_PATH=/usr/share/nodejs # Debian's emscripten looks for its own JavaScript packages there
  configure wasm && compile wasm && node bindings/wasm/split_engine.mjs build/wasm &&
    zstd --ultra -22 -q -f build/wasm/limber_engine_first.wasm build/wasm/limber_engine_rest.wasm
}

# install_node_packages <folder>: what its package-lock.json names, unless it is there. One at a time, for stages that
# run at once.
install_node_packages() {
  local folder=$1 log=build/npm.log status=0
  mkdir -p build
  exec 8>build/npm.lock
  flock 8
  if [ ! "$folder/node_modules/.package-lock.json" -nt "$folder/package-lock.json" ]; then
    npm --prefix "$folder" ci --silent --no-progress </dev/null >"$log" 2>&1 8>&- || { status=1; tail -n 20 "$log" >&2; }
  fi
  exec 8>&-
  return $status
}

# The program with dist/ in it; tests and benchmarks are left as an earlier configuration has them.
build_program_with_studio() {
  configure release -DLIMBER_STUDIO=ON && compile release limber
}

# The libraries and the module for Python, too, for packages of them.
build_everything_with_studio() {
  configure release -DLIMBER_STUDIO=ON -DLIMBER_PYTHON=ON && compile release
}

# Types checked, then dist/ made.
build_studio() {
  install_node_packages apps/studio || return 1
  npm --prefix apps/studio run --silent build </dev/null >build/studio.log 2>&1 || { tail -n 40 build/studio.log >&2; return 1; }
}
