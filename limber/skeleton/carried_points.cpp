#include "limber/skeleton/carried_points.h"

#include <Eigen/Eigenvalues>

#include "limber/core/error.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

constexpr float kMinWeight = 1.0f / 16;

struct VertexSpread {
  double count = 0;
  Vec3 sum = Vec3::Zero();
  Mat3 squares = Mat3::Zero();
  Mat3 axes = Mat3::Identity();  // columns
  Box box;                       // along these

  void add(const Vec3& point) {
    ++count;
    sum += point;
    squares += point * point.transpose();
  }

  void findAxes() {
    const Mat3 covariance = squares / count - sum * sum.transpose() / (count * count);
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
    if (solver.info() == Eigen::Success && solver.eigenvectors().allFinite()) axes = solver.eigenvectors();
  }
};

}  // namespace

CarriedPoints carriedPoints(const Skeleton& skeleton, std::span<const Vec3f> positions, const SkinWeights& weights) {
  if (weights.vertexCount() != positions.size()) {
    throw Error(ErrorCode::kBadArgument, "weights and positions are of different vertices");
  }
  const std::vector<Affine> toJoint = inverseBindOf(skeleton);
  std::vector<VertexSpread> spreads(skeleton.jointCount());
  const auto forEach = [&](const auto& act) {
    for (Index v = 0; v < positions.size(); ++v) {
      for (Index slot = 0; slot < weights.slots; ++slot) {
        if (weights.weightsOf(v)[slot] < kMinWeight) continue;
        const Index joint = weights.jointsOf(v)[slot];
        act(spreads[joint], Vec3(toJoint[joint] * positions[v].cast<double>()));
      }
    }
  };
  forEach([](VertexSpread& spread, const Vec3& point) { spread.add(point); });
  for (VertexSpread& spread : spreads) {
    if (spread.count > 0) spread.findAxes();
  }
  forEach([](VertexSpread& spread, const Vec3& point) { spread.box.add(spread.axes.transpose() * point); });

  CarriedPoints result;
  result.of.resize(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const VertexSpread& spread = spreads[j];
    if (spread.box.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 point((corner & 1 ? spread.box.max : spread.box.min).x(),
                       (corner & 2 ? spread.box.max : spread.box.min).y(),
                       (corner & 4 ? spread.box.max : spread.box.min).z());
      result.of[j].push_back(spread.axes * point);
    }
  }
  for (const Bone& bone : bonesOf(skeleton)) {
    result.of[bone.joint].push_back(toJoint[bone.joint] * bone.a);
    if (bone.b != bone.a) result.of[bone.joint].push_back(toJoint[bone.joint] * bone.b);
  }
  return result;
}

}  // namespace limber
