#include "limber/preview/image/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/preview/image/palette.h"

namespace limber {

namespace {

// Linear values of all bytes.
const std::array<float, 256>& linearTable() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table;
    for (int i = 0; i < 256; ++i) table[static_cast<std::size_t>(i)] = linearFromSrgb(i, i, i).x();
    return table;
  }();
  return kTable;
}

// The byte nearest to a linear value, from a table that is fine enough for the dark end of the curve.
std::uint8_t byteOf(float linear) {
  constexpr int kSteps = 8192;
  static const std::vector<std::uint8_t> kTable = [] {
    std::vector<std::uint8_t> table(kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) table[static_cast<std::size_t>(i)] = srgbByte(double(i) / kSteps);
    return table;
  }();
  return kTable[static_cast<std::size_t>(linear * kSteps + 0.5f)];
}

const std::uint8_t* pixelAt(const Image& image, int x, int y) {
  return image.pixels.data() + 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
}

// Each pixel the mean of the two by two (two by one, ...) above it; of an odd row or column the last one is left out.
Image halved(const Image& image) {
  Image half{std::max(1, image.width / 2), std::max(1, image.height / 2), {}};
  half.pixels.resize(std::size_t(half.width) * std::size_t(half.height) * 3);
  const std::array<float, 256>& linear = linearTable();
  parallelFor(std::size_t(half.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y0 = std::min(2 * int(row), image.height - 1), y1 = std::min(2 * int(row) + 1, image.height - 1);
      for (int x = 0; x < half.width; ++x) {
        const int x0 = std::min(2 * x, image.width - 1), x1 = std::min(2 * x + 1, image.width - 1);
        std::uint8_t* const out = half.pixels.data() + 3 * (row * std::size_t(half.width) + std::size_t(x));
        for (int c = 0; c < 3; ++c) {
          out[c] = byteOf(0.25f * (linear[pixelAt(image, x0, y0)[c]] + linear[pixelAt(image, x1, y0)[c]] +
                                   linear[pixelAt(image, x0, y1)[c]] + linear[pixelAt(image, x1, y1)[c]]));
        }
      }
    }
  });
  return half;
}

// The pixel for `index`, which may lie beyond the picture.
int wrapped(std::int64_t index, int size, TextureWrap wrap) {
  if (wrap == TextureWrap::kClamp) return static_cast<int>(std::clamp<std::int64_t>(index, 0, size - 1));
  const std::int64_t period = wrap == TextureWrap::kMirror ? 2 * std::int64_t{size} : size;
  const std::int64_t within = ((index % period) + period) % period;
  return static_cast<int>(within < size ? within : period - 1 - within);
}

}  // namespace

Texture::Texture(Image image, TextureWrap across, TextureWrap down, std::vector<std::uint8_t> alpha)
    : alpha_(std::move(alpha)), across_(across), down_(down) {
  checkSize(image);
  if (!alpha_.empty() && 3 * alpha_.size() != image.pixels.size()) {
    throw Error(ErrorCode::kBadArgument, "a texture's alpha does not fill its width and height");
  }
  levels_.push_back(std::move(image));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

Vec3 Texture::sample(const Vec2f& uv, double level) const {
  const double last = double(levels_.size() - 1);
  const double position = level > 0 ? std::min(level, last) : 0.0;
  const std::size_t fine = static_cast<std::size_t>(position);
  const double part = position - double(fine);
  const Vec3 color = sampleLevel(levels_[fine], uv);
  if (!(part > 0)) return color;
  return (1 - part) * color + part * sampleLevel(levels_[fine + 1], uv);
}

template <typename Add>
void Texture::forNearestPixels(int width, int height, const Vec2f& uv, const Add& add) const {
  const auto positionOf = [](float coordinate, int size) {
    constexpr double kFarthest = 1e6;  // pictures away; beyond, floats do not tell pixels apart
    return std::isfinite(coordinate) ? std::clamp<double>(coordinate, -kFarthest, kFarthest) * size - 0.5 : 0.0;
  };
  const double x = positionOf(uv.x(), width), y = positionOf(uv.y(), height);
  const double left = std::floor(x), top = std::floor(y);
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const double weight = (dx ? x - left : 1 - (x - left)) * (dy ? y - top : 1 - (y - top));
    const int column = wrapped(std::int64_t(left) + dx, width, across_);
    const int row = wrapped(std::int64_t(top) + dy, height, down_);
    add(std::size_t(row) * std::size_t(width) + std::size_t(column), weight);
  }
}

Vec3 Texture::sampleLevel(const Image& image, const Vec2f& uv) const {
  const std::array<float, 256>& linear = linearTable();
  Vec3 color = Vec3::Zero();
  forNearestPixels(image.width, image.height, uv, [&](std::size_t pixel, double weight) {
    for (std::size_t c = 0; c < 3; ++c) {
      color[static_cast<Eigen::Index>(c)] += weight * linear[image.pixels[3 * pixel + c]];
    }
  });
  return color;
}

double Texture::alphaAt(const Vec2f& uv) const {
  if (alpha_.empty()) return 1;
  double alpha = 0;
  forNearestPixels(width(), height(), uv, [&](std::size_t pixel, double weight) { alpha += weight * alpha_[pixel]; });
  return alpha / 255;
}

}  // namespace limber
