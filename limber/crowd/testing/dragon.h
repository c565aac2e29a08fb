// A small rigged dragon, made once for all tests of the module.
#pragma once

#include "limber/samples/samples.h"

namespace limber {

inline Asset dragon() {
  static const Asset made = makeSample("flying");
  return made.clone();
}

}  // namespace limber
