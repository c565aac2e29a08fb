// Colours that tell joints apart, and one scale from little to much. Linear RGB.
#pragma once

#include <cstdint>

#include "limber/anatomy/anatomy.h"

namespace limber {

// sRGB components, 0 to 255, to linear RGB, and back to bytes (clamped).
Vec3f linearFromSrgb(int red, int green, int blue);
std::uint8_t srgbByte(double linear);

// A colour of joint `number`, well apart from those of the numbers near it.
Vec3f jointColor(Index number);

// A colour for each kind of part, lighter on the body's left; grey for joints of no part.
Vec3f partColor(PartKind kind, Side side);

// value 0 to 1: dark blue, through green and yellow, to red.
Vec3f heatColor(double value);

}  // namespace limber
