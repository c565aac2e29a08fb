// Colours that tell joints apart, and one scale from little to much. Linear RGB.
#pragma once

#include <cstdint>

#include "limber/character/anatomy/part_color.h"

namespace limber {

// sRGB components, 0 to 255, to linear RGB, and back to bytes (clamped).
Vec3f linearFromSrgb(int red, int green, int blue);
std::uint8_t srgbByte(double linear);

// A colour of joint `number`, well apart from those of the numbers near it.
Vec3f jointColor(Index number);

Vec3f linearFromHsv(const Hsv& color);

// value 0 to 1: dark blue, through green and yellow, to red.
Vec3f heatColor(double value);

}  // namespace limber
