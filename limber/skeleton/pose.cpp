#include "limber/skeleton/pose.h"

#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

// Rounding in a product of double transforms; far below what a float vertex can show.
constexpr double kPoseRounding = 1e-12;

bool isIdentityButForRounding(const Affine& map, double reach) {
  return (map.linear() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kPoseRounding &&
         map.translation().cwiseAbs().maxCoeff() <= kPoseRounding * reach;
}

}  // namespace

Pose restPose(const Skeleton& skeleton) {
  return {restLocals(skeleton)};
}

std::vector<Affine> poseGlobals(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Affine> globals(skeleton.jointCount());
  globalTransforms(skeleton, pose.locals, globals);
  return globals;
}

std::vector<Vec3> posePositions(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Vec3> positions;
  positions.reserve(skeleton.joints.size());
  for (const Affine& global : poseGlobals(skeleton, pose)) positions.push_back(global.translation());
  return positions;
}

std::vector<Vec3> restPositions(const Skeleton& skeleton) {
  return posePositions(skeleton, restPose(skeleton));
}

std::vector<Affine> inverseBindOf(const Skeleton& skeleton) {
  std::vector<Affine> inverses = restGlobals(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    inverses[j] = Affine(inverses[j].inverse());
    if (!inverses[j].matrix().allFinite()) {
      throw Error(ErrorCode::kBadData, "has a rest transform without an inverse",
                  fmt::format("joint {} '{}'", j, skeleton.joints[j].name), "give the joint a scale other than 0");
    }
  }
  return inverses;
}

void skinTransforms(std::span<const Affine> globals, std::span<const Affine> inverseBind, std::span<Affine> skin) {
  if (globals.size() != skin.size() || inverseBind.size() != skin.size()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} global and {} inverse bind transforms for {} joints",
                                                     globals.size(), inverseBind.size(), skin.size()));
  }
  for (std::size_t j = 0; j < skin.size(); ++j) {
    const double reach = 1e-3 + globals[j].translation().cwiseAbs().maxCoeff();
    skin[j] = globals[j] * inverseBind[j];
    if (isIdentityButForRounding(skin[j], reach)) skin[j] = Affine::Identity();
  }
}

std::vector<Affine> skinTransforms(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Affine> skin(skeleton.jointCount());
  skinTransforms(poseGlobals(skeleton, pose), inverseBindOf(skeleton), skin);
  return skin;
}

}  // namespace limber
