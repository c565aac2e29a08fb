#include "limber/preview/rasterizer.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

constexpr std::int32_t kSubpixels = 256;
constexpr std::int32_t kTileSpan = kTileSize * kSubpixels;
constexpr std::int32_t kOffsetScale = kSubpixels / 16;
constexpr double kFarthestPixel = 1 << 29;  // positions beyond are clamped, so that 32 bits hold them

std::int32_t snap(double pixel) {
  return static_cast<std::int32_t>(std::lround(std::clamp(pixel * kSubpixels, -kFarthestPixel, kFarthestPixel)));
}

// Twice the signed area of a, b, (x, y). Exact, and equal but for its sign when a and b are swapped, so that
// neighbouring triangles leave no gap.
std::int64_t edge(const ProjectedMesh::Vertex& a, const ProjectedMesh::Vertex& b, std::int64_t x, std::int64_t y) {
  return (std::int64_t{b.x} - a.x) * (y - a.y) - (std::int64_t{b.y} - a.y) * (x - a.x);
}

}  // namespace

ProjectedMesh::ProjectedMesh(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                             const Camera& camera)
    : triangles_(triangles),
      columns_((camera.width + kTileSize - 1) / kTileSize),
      rows_((camera.height + kTileSize - 1) / kTileSize) {
  vertices_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 seen = camera.project(positions[i].cast<double>());
    if (!(seen.z() > 1e-9)) continue;
    vertices_[i] = {snap(seen.x()), snap(seen.y()), static_cast<float>(1 / seen.z())};
  }
  const auto forEachTile = [&](const Triangle& triangle, auto&& visit) {
    std::array<int, 4> range;
    if (!tilesOf(triangle, range)) return;
    for (int row = range[2]; row <= range[3]; ++row) {
      for (int column = range[0]; column <= range[1]; ++column)
        visit(std::size_t(row) * std::size_t(columns_) + std::size_t(column));
    }
  };
  inTile_ = Grouped<Index>(std::size_t(columns_) * std::size_t(rows_), [&](const auto& visit) {
    for (Index t = 0; t < triangles.size(); ++t) {
      forEachTile(triangles[t], [&](std::size_t tile) { visit(tile, t); });
    }
  });
}

bool ProjectedMesh::tilesOf(const Triangle& triangle, std::array<int, 4>& range) const {
  const Vertex &a = vertices_[triangle[0]], &b = vertices_[triangle[1]], &c = vertices_[triangle[2]];
  if (a.inverseDepth == 0 || b.inverseDepth == 0 || c.inverseDepth == 0) return false;
  const auto tile = [](std::int32_t position) { return static_cast<int>(position >> 13); };
  static_assert(kTileSpan == 1 << 13);
  range = {std::max(0, tile(std::min({a.x, b.x, c.x}))), std::min(columns_ - 1, tile(std::max({a.x, b.x, c.x}))),
           std::max(0, tile(std::min({a.y, b.y, c.y}))), std::min(rows_ - 1, tile(std::max({a.y, b.y, c.y})))};
  return range[0] <= range[1] && range[2] <= range[3];
}

std::span<const Index> ProjectedMesh::inTile(int column, int row) const {
  return inTile_.of(std::size_t(row) * std::size_t(columns_) + std::size_t(column));
}

Vec3 ProjectedMesh::barycentric(Index triangle, std::int32_t x, std::int32_t y) const {
  const Triangle& t = triangles_[triangle];
  const Vertex &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
  const Vec3 weights(double(edge(b, c, x, y)) * a.inverseDepth, double(edge(c, a, x, y)) * b.inverseDepth,
                     double(edge(a, b, x, y)) * c.inverseDepth);
  const double sum = weights.sum();
  return sum != 0 ? Vec3(weights / sum) : Vec3(Vec3::Constant(1.0 / 3));
}

TileSamples::TileSamples()
    : inverseDepth(std::size_t{kTileSize} * kTileSize * kSamplesPerPixel, 0.0f),
      triangle(std::size_t{kTileSize} * kTileSize * kSamplesPerPixel, kNoIndex) {}

void TileSamples::clear() {
  std::fill(inverseDepth.begin(), inverseDepth.end(), 0.0f);
  std::fill(triangle.begin(), triangle.end(), kNoIndex);
}

void rasterizeTile(const ProjectedMesh& mesh, int column, int row, TileSamples& samples, const SampleCover& covers) {
  const std::int32_t left = column * kTileSpan, top = row * kTileSpan;
  for (const Index number : mesh.inTile(column, row)) {
    const Triangle& triangle = mesh.triangles()[number];
    const auto &a = mesh.vertices()[triangle[0]], &b = mesh.vertices()[triangle[1]], &c = mesh.vertices()[triangle[2]];
    const std::int64_t area = edge(a, b, c.x, c.y);
    if (area == 0) continue;
    const std::int64_t sign = area > 0 ? 1 : -1;
    const double scale = 1 / double(area);
    const int x0 = std::max((std::min({a.x, b.x, c.x}) - left) / kSubpixels, 0);
    const int x1 = std::min((std::max({a.x, b.x, c.x}) - left) / kSubpixels, kTileSize - 1);
    const int y0 = std::max((std::min({a.y, b.y, c.y}) - top) / kSubpixels, 0);
    const int y1 = std::min((std::max({a.y, b.y, c.y}) - top) / kSubpixels, kTileSize - 1);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const std::size_t pixel = (std::size_t(y) * kTileSize + std::size_t(x)) * kSamplesPerPixel;
        for (std::size_t s = 0; s < kSamplesPerPixel; ++s) {
          const std::int64_t sx = left + x * kSubpixels + kSampleOffsets[s][0] * kOffsetScale;
          const std::int64_t sy = top + y * kSubpixels + kSampleOffsets[s][1] * kOffsetScale;
          const std::int64_t wa = edge(b, c, sx, sy), wb = edge(c, a, sx, sy), wc = edge(a, b, sx, sy);
          if (wa * sign < 0 || wb * sign < 0 || wc * sign < 0) continue;
          const float inverseDepth = static_cast<float>(
              (double(wa) * a.inverseDepth + double(wb) * b.inverseDepth + double(wc) * c.inverseDepth) * scale);
          if (inverseDepth <= samples.inverseDepth[pixel + s]) continue;
          if (covers && !covers(number, static_cast<std::int32_t>(sx), static_cast<std::int32_t>(sy), s)) continue;
          samples.inverseDepth[pixel + s] = inverseDepth;
          samples.triangle[pixel + s] = number;
        }
      }
    }
  }
}

}  // namespace limber
