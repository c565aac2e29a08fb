// How far a call is, for who listens in JavaScript.
#pragma once

#include <string_view>

#include <emscripten/emscripten.h>

namespace limber::wasm {

// Tells Module.onProgress, where it was given.
inline void reportProgress(std::string_view stage, double fraction) {
  EM_ASM(
      {
        if (Module["onProgress"]) Module["onProgress"](UTF8ToString($0, $1), $2);
      },
      stage.data(), stage.size(), fraction);
}

}  // namespace limber::wasm
