/// <reference types="vite/client" />

// An Emscripten module without types of its own; engine/codecs.ts says what is used of it.
declare module 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js' {
  export default function createModule(options: object): unknown;
}
