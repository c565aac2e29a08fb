// Pictures one after the other in one PNG file.
#pragma once

#include <span>

#include "limber/preview/image/image.h"

namespace limber {

// An animated PNG (PNG third edition: acTL, fcTL, fdAT) that plays for ever; programs that do not know it show the
// first frame. Images of equal size. The same images give the same bytes. Throws Error kBadArgument where there is
// none, sizes differ, or the rate is not between 0.1 and 1000 frames a second.
Bytes encodeApng(std::span<const Image> frames, double framesPerSecond);

}  // namespace limber
