#include "limber/rigging/transfer/offset_transfer.h"

#include <cmath>

#include <Eigen/LU>

namespace limber {

namespace {

// The triangle's two edges and its normal; `area` is twice its own.
Mat3 frameOf(const Vec3& a, const Vec3& b, const Vec3& c, double& area) {
  Mat3 frame;
  const Vec3 normal = (b - a).cross(c - a);
  area = normal.norm();
  frame.col(0) = b - a;
  frame.col(1) = c - a;
  frame.col(2) = area > 0 ? Vec3(normal / std::sqrt(area)) : Vec3(Vec3::Zero());
  return frame;
}

}  // namespace

std::vector<Mat3> deformationGradients(const TriMesh& before, std::span<const Vec3> after) {
  std::vector<Mat3> gradients(before.vertexCount(), Mat3::Zero());
  std::vector<double> areas(before.vertexCount(), 0);
  for (const auto& [a, b, c] : before.triangles) {
    double area = 0, areaAfter = 0;
    const Mat3 rest = frameOf(before.position(a), before.position(b), before.position(c), area);
    const Mat3 gradient = frameOf(after[a], after[b], after[c], areaAfter) * rest.inverse();
    if (!(area > 0) || !gradient.allFinite()) continue;
    for (const Index v : {a, b, c}) {
      gradients[v] += area * gradient;
      areas[v] += area;
    }
  }
  for (std::size_t v = 0; v < gradients.size(); ++v) {
    if (areas[v] > 0) {
      gradients[v] /= areas[v];
    } else {
      gradients[v].setIdentity();
    }
  }
  return gradients;
}

std::vector<Vec3f> carriedOffsets(const TriMesh& source, std::span<const Mat3> gradients,
                                  std::span<const Vec3f> offsets, std::span<const SurfacePoint> points) {
  std::vector<Vec3f> result;
  result.reserve(points.size());
  for (const SurfacePoint& point : points) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Index v = source.triangles[point.triangle][corner];
      sum += point.weights[static_cast<Eigen::Index>(corner)] * (gradients[v] * offsets[v].cast<double>());
    }
    result.push_back(sum.cast<float>());
  }
  return result;
}

}  // namespace limber
