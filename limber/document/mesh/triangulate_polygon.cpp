#include "limber/document/mesh/triangulate_polygon.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

constexpr std::size_t kMaxCornersCut = 1024;
constexpr std::size_t kTestsPerCorner = 32;  // of ears; spirals need most

using Vec2 = Eigen::Vector2d;

double crossOf(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// In the plane across the area normal, with positive area.
std::vector<Vec2> flattened(std::span<const Vec3> corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  int along = 0;
  normal.cwiseAbs().maxCoeff(&along);
  const int u = (along + 1) % 3, v = (along + 2) % 3;
  const double sign = normal[along] < 0 ? -1 : 1;
  std::vector<Vec2> result;
  result.reserve(corners.size());
  for (const Vec3& corner : corners) result.emplace_back(sign * corner[u], corner[v]);
  return result;
}

class EarCutter {
 public:
  explicit EarCutter(std::span<const Vec3> corners) : positions_(flattened(corners)) {
    for (Index i = 0; i < corners.size(); ++i) left_.push_back(i);
  }

  bool isConvex() const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (turnAt(i) <= 0) return false;
    }
    return true;
  }

  void run(std::vector<std::array<Index, 3>>& triangles) {
    std::size_t at = 1, tried = 0;
    for (std::size_t tests = kTestsPerCorner * left_.size(); left_.size() > 3 && tried < left_.size() && tests > 0;
         --tests) {
      if (at >= left_.size()) at = 0;
      if (!isEar(at)) {
        ++at;
        ++tried;
        continue;
      }
      triangles.push_back({before(at), left_[at], after(at)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
      tried = 0;
    }
    for (std::size_t i = 1; i + 1 < left_.size(); ++i) triangles.push_back({left_[0], left_[i], left_[i + 1]});
  }

 private:
  Index before(std::size_t i) const { return left_[i == 0 ? left_.size() - 1 : i - 1]; }
  Index after(std::size_t i) const { return left_[i + 1 == left_.size() ? 0 : i + 1]; }

  double turnAt(std::size_t i) const {
    const Vec2 &a = positions_[before(i)], &b = positions_[left_[i]], &c = positions_[after(i)];
    return crossOf(b - a, c - b);
  }

  bool isEar(std::size_t i) const {
    if (turnAt(i) <= 0) return false;
    const Vec2 &a = positions_[before(i)], &b = positions_[left_[i]], &c = positions_[after(i)];
    return std::none_of(left_.begin(), left_.end(), [&](Index other) {
      if (other == before(i) || other == left_[i] || other == after(i)) return false;
      const Vec2& p = positions_[other];
      if (p == a || p == b || p == c) return false;  // a bridge to a hole passes through a corner twice
      return crossOf(b - a, p - a) >= 0 && crossOf(c - b, p - b) >= 0 && crossOf(a - c, p - c) >= 0;
    });
  }

  std::vector<Vec2> positions_;
  std::vector<Index> left_;
};

void addFan(std::size_t count, std::vector<std::array<Index, 3>>& triangles) {
  for (Index i = 1; i + 1 < count; ++i) triangles.push_back({0, i, i + 1});
}

}  // namespace

void triangulatePolygon(std::span<const Vec3> corners, std::vector<std::array<Index, 3>>& triangles) {
  if (corners.size() == 3) return addFan(3, triangles);
  EarCutter cutter(corners);
  const bool isConvex = cutter.isConvex();
  if (corners.size() == 4 && isConvex) {
    if ((corners[0] - corners[2]).squaredNorm() <= (corners[1] - corners[3]).squaredNorm()) {
      return addFan(4, triangles);
    }
    triangles.push_back({0, 1, 3});
    triangles.push_back({1, 2, 3});
    return;
  }
  if (isConvex || corners.size() > kMaxCornersCut) return addFan(corners.size(), triangles);
  cutter.run(triangles);
}

}  // namespace limber
