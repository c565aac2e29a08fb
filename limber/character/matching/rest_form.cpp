#include "limber/character/matching/rest_form.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "limber/character/anatomy/anatomy.h"
#include "limber/core/text/numbers.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

struct FormSearch {
  // Fraction of the bones' length, by the squared sine between bone and line; 0.001 to 0.1; that may point away from
  // the line: 0.02 is 8 degrees for all of them. Measured: people in T-pose have 0.3 and more, with arms and legs
  // hanging parallel 0.1 by their feet; zeroed axes have 0.
  double offLine = 0.02;
  std::size_t minLimbs = 4;      // chains; 3 to 4; snakes and fish are straight and have a form all the same
  std::size_t minLimbBones = 2;  // bones; 2 alone: thigh and shin
  int maxMoments = 100;          // frames of each clip; 20 to 1000; bounds time; set by hand
};
constexpr FormSearch kFormSearch;

// #J, the joint in which each joint's bone ends: the only child, or the only one that has children itself. Twist joints
// and tips beside it carry nothing.
std::vector<std::optional<Index>> boneEnds(const Skeleton& skeleton) {
  const std::vector<std::vector<Index>> children = childrenOf(skeleton);
  std::vector<std::optional<Index>> ends(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    std::vector<Index> below = children[j];
    if (below.size() > 1) std::erase_if(below, [&](Index child) { return children[child].empty(); });
    if (below.size() == 1) ends[j] = below.front();
  }
  return ends;
}

// A run of bones, each at the end of the one before.
using Chain = std::vector<Index>;  // its joints

// Those that may be limbs. One that begins at a root is the path to the hips and tells nothing.
std::vector<Chain> limbsOf(const Skeleton& skeleton) {
  const std::vector<std::optional<Index>> ends = boneEnds(skeleton);
  std::vector<bool> begins(ends.size());
  for (Index j = 0; j < skeleton.jointCount(); ++j) begins[j] = skeleton.joints[j].parent.has_value();
  for (const std::optional<Index>& end : ends) {
    if (end) begins[*end] = false;
  }
  std::vector<Chain> limbs;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Chain chain;
    for (std::optional<Index> at = j; begins[j] && at; at = ends[*at]) chain.push_back(*at);
    if (chain.size() > kFormSearch.minLimbBones) limbs.push_back(std::move(chain));
  }
  return limbs;
}

double heightOf(const std::vector<Vec3>& positions) {
  const auto [low, high] = std::minmax_element(positions.begin(), positions.end(),
                                               [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  return high->y() - low->y();
}

Pose turnedAboutY(const Skeleton& skeleton, Pose pose, double radians) {
  const Quat turn(Eigen::AngleAxisd(radians, Vec3::UnitY()));
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent) continue;
    Transform& local = pose.locals[j];
    local.translation = turn * local.translation;
    local.rotation = (turn * local.rotation).normalized();
  }
  return pose;
}

// Turned so that the body's left is +X, as files have it at rest: where up and ahead are uncertain, readAnatomy uses
// that convention, which a frame within a motion does not keep. Which side is left is most certain where names agree
// with it.
Pose turnedAhead(const Skeleton& skeleton, const Pose& pose) {
  // Fraction of the left's length; 0.3 to 0.8; one who lies on a side stays as it is; set by hand.
  constexpr double kMinLevel = 0.5;
  const Vec3 left = readAnatomy(skeleton, pose).axes.left();
  if (std::hypot(left.x(), left.z()) < kMinLevel) return pose;
  const double radians = std::atan2(left.z(), left.x());
  Pose ahead = turnedAboutY(skeleton, pose, radians), back = turnedAboutY(skeleton, pose, radians + kPi);
  return readAnatomy(skeleton, back).confidence > readAnatomy(skeleton, ahead).confidence ? back : ahead;
}

}  // namespace

bool hasForm(const Skeleton& skeleton, const Pose& pose) {
  const std::vector<Chain> limbs = limbsOf(skeleton);
  if (limbs.size() < kFormSearch.minLimbs) return true;
  const std::vector<Vec3> positions = posePositions(skeleton, pose);
  Mat3 sum = Mat3::Zero();
  double length = 0;
  for (const Chain& limb : limbs) {
    for (std::size_t i = 1; i < limb.size(); ++i) {
      const Vec3 bone = positions[limb[i]] - positions[limb[i - 1]];
      const double own = bone.norm();
      if (!(own > 0)) continue;
      sum += bone * bone.transpose() / own;
      length += own;
    }
  }
  if (!(length > 0) || !sum.allFinite()) return true;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(sum, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[2] < (1 - kFormSearch.offLine) * length;
}

std::optional<Pose> poseWithForm(const Skeleton& skeleton, std::span<const Pose> motion) {
  if (hasForm(skeleton, restPose(skeleton))) return std::nullopt;
  const Pose* tallest = nullptr;
  double height = 0;
  for (const Pose& pose : motion) {
    const double own = heightOf(posePositions(skeleton, pose));
    if ((tallest && !(own > height)) || !hasForm(skeleton, pose)) continue;
    tallest = &pose;
    height = own;
  }
  return tallest ? std::optional(turnedAhead(skeleton, *tallest)) : std::nullopt;
}

std::optional<Pose> poseWithForm(const Motion& motion) {
  if (hasForm(motion.skeleton, restPose(motion.skeleton))) return std::nullopt;
  std::vector<Pose> poses;
  for (const Clip& clip : motion.clips) {
    for (int i = 0; i < kFormSearch.maxMoments; ++i) {
      poses.push_back(restPose(motion.skeleton));
      sampleClip(clip, clip.duration() * i / kFormSearch.maxMoments, poses.back());
    }
  }
  return poseWithForm(motion.skeleton, poses);
}

Skeleton restingIn(Skeleton skeleton, const Pose& pose) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) skeleton.joints[j].rest = pose.locals[j];
  return skeleton;
}

Skeleton skeletonWithForm(const Motion& motion) {
  const std::optional<Pose> pose = poseWithForm(motion);
  return pose ? restingIn(motion.skeleton, *pose) : motion.skeleton;
}

SkeletonMap matchMotion(const Motion& motion, const SkeletonReading& source, const SkeletonReading& target,
                        bool unlikeBodies) {
  const std::optional<Pose> pose = poseWithForm(motion);
  return matchSkeletons(source, target, unlikeBodies, pose ? &*pose : nullptr);
}

}  // namespace limber
