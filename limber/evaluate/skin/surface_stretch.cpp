#include "limber/evaluate/skin/surface_stretch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

std::array<Vec3, 3> cornersOf(std::span<const Vec3f> positions, const Triangle& t) {
  return {positions[t[0]].cast<double>(), positions[t[1]].cast<double>(), positions[t[2]].cast<double>()};
}

double areaOf(const std::array<Vec3, 3>& corners) {
  return triangleArea(corners[0], corners[1], corners[2]);
}

// The value at or below which `fraction` of the weight lies.
double weightedQuantile(const std::vector<double>& values, const std::vector<double>& weights, double fraction) {
  std::vector<Index> order(values.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  const double sought = fraction * std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0;
  for (const Index i : order) {
    sum += weights[i];
    if (sum >= sought) return values[i];
  }
  return order.empty() ? 0 : values[order.back()];
}

}  // namespace

double TriangleStretch::distortion() const {
  return std::min(kMaxDistortion, std::max(most, least > 0 ? 1 / least : kMaxDistortion));
}

std::optional<TriangleStretch> triangleStretch(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to) {
  const Vec3 along = from[1] - from[0], across = from[2] - from[0];
  const double length = along.norm(), height = along.cross(across).norm() / length;
  if (!(length > 0) || !(height > 0)) return std::nullopt;
  // The images of the unit vectors along the first side and at right angles to it within the triangle.
  const Vec3 x = (to[1] - to[0]) / length;
  const Vec3 y = (to[2] - to[0] - along.dot(across) / length * x) / height;
  const double xx = x.squaredNorm(), xy = x.dot(y), yy = y.squaredNorm();
  TriangleStretch stretch;
  stretch.most = std::sqrt(0.5 * (xx + yy + std::hypot(xx - yy, 2 * xy)));
  stretch.least = stretch.most > 0 ? std::min(stretch.most, x.cross(y).norm() / stretch.most) : 0;
  return stretch;
}

std::vector<double> triangleDistortions(std::span<const Vec3f> rest, std::span<const Vec3f> posed,
                                        std::span<const Triangle> triangles) {
  std::vector<double> distortions;
  distortions.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const std::optional<TriangleStretch> stretch = triangleStretch(cornersOf(rest, t), cornersOf(posed, t));
    distortions.push_back(stretch ? stretch->distortion() : 1);
  }
  return distortions;
}

SurfaceStretch surfaceStretch(std::span<const Vec3f> rest, std::span<const Vec3f> posed,
                              std::span<const Triangle> triangles) {
  const std::vector<double> distortions = triangleDistortions(rest, posed, triangles);
  std::vector<double> areas;
  areas.reserve(triangles.size());
  for (const Triangle& t : triangles) areas.push_back(areaOf(cornersOf(rest, t)));
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  if (!(area > 0)) return {};
  SurfaceStretch result;
  for (std::size_t f = 0; f < areas.size(); ++f) result.mean += areas[f] / area * (distortions[f] - 1);
  result.p95 = weightedQuantile(distortions, areas, 0.95) - 1;
  return result;
}

std::optional<double> textureStretch(std::span<const Vec2f> uvs, std::span<const Vec3f> positions,
                                     std::span<const Triangle> triangles) {
  const auto texelsOf = [&](const Triangle& t) {
    std::array<Vec3, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = {double{uvs[t[c]].x()}, double{uvs[t[c]].y()}, 0};
    return corners;
  };
  double area = 0, textureArea = 0, sum = 0;
  for (const Triangle& t : triangles) {
    const std::array<Vec3, 3> texels = texelsOf(t), corners = cornersOf(positions, t);
    const std::optional<TriangleStretch> stretch = triangleStretch(texels, corners);
    if (!stretch) continue;
    const double own = areaOf(corners);
    area += own;
    textureArea += areaOf(texels);
    sum += 0.5 * own * (stretch->most * stretch->most + stretch->least * stretch->least);
  }
  if (!(area > 0) || !(textureArea > 0)) return std::nullopt;
  return std::sqrt(sum / area * textureArea / area);
}

}  // namespace limber
