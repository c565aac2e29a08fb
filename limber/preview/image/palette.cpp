#include "limber/preview/image/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/srgb.h"

namespace limber {

namespace {

// Hue (0 to 1), saturation and value as usual, to sRGB and from there to linear.
Vec3f fromHsv(double hue, double saturation, double value) {
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue * 6, 6.0);
    return value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  };
  return Vec3(linearOf(channel(5)), linearOf(channel(3)), linearOf(channel(1))).cast<float>();
}

}  // namespace

Vec3f linearFromSrgb(int red, int green, int blue) {
  return Vec3(linearOf(red / 255.0), linearOf(green / 255.0), linearOf(blue / 255.0)).cast<float>();
}

std::uint8_t srgbByte(double linear) {
  return static_cast<std::uint8_t>(std::lround(srgbOf(std::clamp(linear, 0.0, 1.0)) * 255));
}

Vec3f jointColor(Index number) {
  // Steps of the golden ratio round the circle never come back close soon; value and saturation vary besides.
  const double hue = std::fmod(0.58 + number * 0.61803398874989485, 1.0);
  constexpr std::array<std::array<double, 2>, 3> kTones = {{{0.62, 0.95}, {0.42, 0.98}, {0.72, 0.80}}};
  const auto& tone = kTones[number % kTones.size()];
  return fromHsv(hue, tone[0], tone[1]);
}

Vec3f linearFromHsv(const Hsv& color) {
  return fromHsv(color.hue, color.saturation, color.value);
}

Vec3f heatColor(double value) {
  static const std::array<Vec3f, 6> kStops = {linearFromSrgb(38, 52, 108),  linearFromSrgb(45, 125, 190),
                                              linearFromSrgb(70, 185, 150), linearFromSrgb(200, 215, 90),
                                              linearFromSrgb(245, 150, 55), linearFromSrgb(205, 40, 45)};
  const double position = std::clamp(value, 0.0, 1.0) * double(kStops.size() - 1);
  const std::size_t lower = std::min(std::size_t(position), kStops.size() - 2);
  const float part = static_cast<float>(position - double(lower));
  return kStops[lower] * (1 - part) + kStops[lower + 1] * part;
}

}  // namespace limber
