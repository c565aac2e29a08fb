// In which colour parts of the body are shown, wherever they are shown.
#pragma once

#include "limber/character/anatomy/anatomy.h"

namespace limber {

struct Hsv {
  double hue = 0, saturation = 0, value = 0;  // 0 to 1 each
};

// One for each kind of part, lighter on the body's left; grey for joints of no part.
Hsv partColor(PartKind kind, Side side);

}  // namespace limber
