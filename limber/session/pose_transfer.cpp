#include "limber/session/pose_transfer.h"

#include <algorithm>

#include "limber/ik/rotation_fit.h"

namespace limber {

namespace {

// How the vertices of one joint lay and lie, weighted.
struct Patch {
  double weight = 0, spread = 0;                     // spread: of the squared distances from the mean, before
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();  // sums, then means
  Mat3 correlation = Mat3::Zero();
};

constexpr double kLeastWeight = 1e-9;
constexpr double kRounding = 1e-5;  // of the longest side

template <class Visit>
void forEachInfluence(const SkinWeights& weights, Visit&& visit) {
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    for (Index k = 0; k < weights.slots; ++k) {
      const float weight = weights.weightsOf(v)[k];
      // Squared: a joint follows what it holds, not what it merely touches.
      if (weight > 0) visit(v, weights.jointsOf(v)[k], double{weight} * weight);
    }
  }
}

bool sameVertices(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  Box box;
  for (const Vec3f& position : a) box.add(position.cast<double>());
  const double tolerance = kRounding * box.longestSide();
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const Vec3f& p, const Vec3f& q) { return (p - q).norm() <= tolerance; });
}

std::vector<Patch> fitPatches(const RiggedModel& to, const std::vector<Vec3f>& after) {
  const std::vector<Vec3f>& before = to.geometry.positions;
  std::vector<Patch> patches(to.skeleton().joints.size());
  forEachInfluence(to.weights, [&](Index v, Index j, double w) {
    patches[j].weight += w;
    patches[j].before += w * before[v].cast<double>();
    patches[j].after += w * after[v].cast<double>();
  });
  for (Patch& patch : patches) {
    if (patch.weight < kLeastWeight) continue;
    patch.before /= patch.weight;
    patch.after /= patch.weight;
  }
  forEachInfluence(to.weights, [&](Index v, Index j, double w) {
    const Vec3 from = before[v].cast<double>() - patches[j].before;
    patches[j].spread += w * from.squaredNorm();
    patches[j].correlation += w * (after[v].cast<double>() - patches[j].after) * from.transpose();
  });
  return patches;
}

}  // namespace

Pose transferPose(const RiggedModel& from, const Pose& pose, const RiggedModel& to) {
  Pose result = to.home;
  if (!sameVertices(from.geometry.positions, to.geometry.positions)) return result;
  if (samePose(pose, from.home)) return result;
  const std::vector<Vec3f> after = posedPositions(from, pose);

  const std::vector<Patch> patches = fitPatches(to, after);
  const std::vector<Affine> rest = restGlobals(to.skeleton());
  std::vector<Affine> motions(patches.size()), globals(patches.size());
  for (Index j = 0; j < patches.size(); ++j) {
    const std::optional<Index> parent = to.skeleton().joints[j].parent;
    const Patch& patch = patches[j];
    if (patch.weight >= kLeastWeight && patch.spread > 0) {
      const Quat rotation = bestRotation(patch.correlation);
      motions[j] = Eigen::Translation3d(patch.after) * rotation * Eigen::Translation3d(-patch.before);
    } else {
      motions[j] = parent ? motions[*parent] : Affine::Identity();
    }
    globals[j] = motions[j] * rest[j];
    result.locals[j] = decompose(parent ? Affine(globals[*parent].inverse(Eigen::Affine) * globals[j]) : globals[j]);
  }
  return result;
}

}  // namespace limber
