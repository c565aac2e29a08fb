// How far a call is, for who listens in JavaScript.
#pragma once

#include <string_view>

#include <emscripten/emscripten.h>

#include "limber/core/progress.h"

namespace limber::wasm {

// Tells Module.onProgress, where it was given. It throws nothing, and gives true where the call is to stop.
class PageProgress {
 public:
  PageProgress() : progress_([this](std::string_view stage, double fraction) { tell(stage, fraction); }) {}

  Progress& operator*() { return progress_; }

 private:
  void tell(std::string_view stage, double fraction) {
    const int stops =
        EM_ASM_INT({ return Module["onProgress"] && Module["onProgress"](UTF8ToString($0, $1), $2) ? 1 : 0; },
                   stage.data(), stage.size(), fraction);
    if (stops != 0) progress_.cancel();
  }

  Progress progress_;
};

}  // namespace limber::wasm
