// The vectors, indices and boxes that every stage speaks in.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace limber {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec4f = Eigen::Vector4f;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;
using Mat4 = Eigen::Matrix4d;
using Quat = Eigen::Quaterniond;  // stored x, y, z, w, as in glTF
using Affine = Eigen::Affine3d;

// Vertices, triangles and joints are counted in 32 bits; readers refuse what does not fit.
using Index = std::uint32_t;
inline constexpr Index kNoIndex =
    std::numeric_limits<Index>::max();  // only inside packed maps; elsewhere std::optional

using Triangle = std::array<Index, 3>;

// Axis-aligned box; empty (min > max) until something is added.
struct Box {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  bool empty() const { return !(min.x() <= max.x()); }
  Vec3 center() const { return 0.5 * (min + max); }
  Vec3 size() const { return empty() ? Vec3(Vec3::Zero()) : Vec3(max - min); }
  double diagonal() const { return size().norm(); }
  double longestSide() const { return size().maxCoeff(); }
};

}  // namespace limber
