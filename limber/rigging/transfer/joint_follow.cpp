#include "limber/rigging/transfer/joint_follow.h"

#include <Eigen/LU>

#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

// Of the covariance's trace: how strongly an affine map is drawn towards a translation.
constexpr double kPinnedToShift = 0.02;

struct Moments {
  double weight = 0;
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();  // sums
  Mat3 square = Mat3::Zero(), cross = Mat3::Zero();  // of before before^T and after before^T, both from the joint

  void add(double w, const Vec3& a, const Vec3& b) {
    weight += w;
    before += w * a;
    after += w * b;
    square += w * a * a.transpose();
    cross += w * b * a.transpose();
  }

  // Where the origin goes.
  Vec3 originAfter() const {
    const Vec3 a = before / weight, b = after / weight;
    const Mat3 covariance = square / weight - a * a.transpose(), with = cross / weight - b * a.transpose();
    const Mat3 hold = (kPinnedToShift * covariance.trace() + 1e-300) * Mat3::Identity();
    const Mat3 map = (with + hold) * (covariance + hold).inverse();
    return b - map * a;
  }
};

}  // namespace

std::vector<Vec3> followSurface(const Skeleton& skeleton, std::span<const Vec3> positions, const TriMesh& before,
                                std::span<const Vec3> after, const SkinWeights& weights) {
  const std::vector<double> areas = vertexAreas(before);
  double total = 0;
  for (const double area : areas) total += area;
  const double least = 1e-6 * total;  // squared distance, so that a vertex in the joint counts finitely
  std::vector<std::vector<Index>> near(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    near[j].push_back(j);
    if (const std::optional<Index> parent = skeleton.joints[j].parent) {
      near[j].push_back(*parent);
      near[*parent].push_back(j);
    }
  }
  std::vector<Moments> moments(skeleton.jointCount());
  for (Index v = 0; v < before.vertexCount(); ++v) {
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const double weight = weights.weightsOf(v)[slot];
      if (!(weight > 0)) continue;
      for (const Index joint : near[weights.jointsOf(v)[slot]]) {
        const Vec3 from = before.position(v) - positions[joint];
        const double distance = from.squaredNorm() + least;
        moments[joint].add(weight * areas[v] / (distance * distance), from, after[v] - positions[joint]);
      }
    }
  }
  std::vector<Vec3> result(positions.begin(), positions.end());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (moments[j].weight > 0) {
      result[j] += moments[j].originAfter();
    } else if (parent) {
      result[j] += result[*parent] - positions[*parent];
    }
  }
  return result;
}

}  // namespace limber
