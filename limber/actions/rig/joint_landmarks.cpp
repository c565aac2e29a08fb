#include "limber/actions/rig/joint_landmarks.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "limber/actions/rig/accessories.h"
#include "limber/actions/rig/figure_geometry.h"
#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/character/matching/skeleton_map.h"
#include "limber/core/counted.h"
#include "limber/core/known_error.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

// Of the body's size: named joints of fitted templates are 2 to 4 % off in the mean (docs/template-rigs.md).
constexpr double kTemplateIsWrong = 0.1;

struct JointPair {
  Index source = 0, target = 0;
};

[[noreturn]] void refuseUnlike(const Skeleton& source, const Skeleton& target) {
  const Index joints = source.jointCount(), others = target.jointCount();
  throw KnownError(
      ErrorKind::kUnlikeRigs,
      {ErrorCode::kUnsupported,
       fmt::format("the rig of {} and the other body's skeleton of {} have too few limbs in common to lay one body on "
                   "the other",
                   counted(joints, "joint"), others),
       "", "take a rigged model of the same kind of body"},
      {{"source", fmt::to_string(joints)}, {"target", fmt::to_string(others)}});
}

SkeletonMap mapOfLimbs(const Skeleton& source, const Skeleton& target) {
  try {
    return matchSkeletons(source, target);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kUnsupported) throw;
    refuseUnlike(source, target);
  }
}

std::optional<Index> hipsOf(const Skeleton& skeleton) {
  const std::vector<HumanoidJoint> joints = humanoidJoints(skeleton);
  const auto hips = std::find_if(joints.begin(), joints.end(), [](const HumanoidJoint& j) { return j.bone == "hips"; });
  return hips != joints.end() ? std::optional(hips->joint) : std::nullopt;
}

// The joints of a pelvis. Where one on the ground carries legs and spine, the hips are another one above it, and only
// these lie in the body.
JointPair pelvisPair(const Skeleton& source, const Skeleton& target, const JointMatch& match) {
  return {hipsOf(source).value_or(match.source[0]), hipsOf(target).value_or(match.target[0])};
}

std::vector<JointPair> commonJoints(const Skeleton& source, const Skeleton& target) {
  const SkeletonMap map = mapOfLimbs(source, target);
  std::vector<JointPair> pairs;
  std::vector<bool> taken(source.jointCount(), false);
  for (const JointMatch& match : map.matches) {
    if (match.source.empty() || match.target.empty()) continue;
    if (match.part == body_part::kPelvis && !map.twins) {
      const JointPair hips = pelvisPair(source, target, match);
      if (!taken[hips.source]) pairs.push_back(hips);
      taken[hips.source] = true;
      continue;
    }
    const bool alike = match.source.size() == match.target.size();
    if (match.part == body_part::kTrunk && !map.twins) continue;
    for (std::size_t i = 0; i < (alike ? match.source.size() : 1); ++i) {
      if (taken[match.source[i]]) continue;
      taken[match.source[i]] = true;
      pairs.push_back({match.source[i], match.target[i]});
    }
  }
  if (pairs.size() < 3) refuseUnlike(source, target);
  return pairs;
}

}  // namespace

std::optional<FittedSkeleton> fittedSkeleton(const Asset& asset, const Geometry& geometry, Progress& progress) {
  const Accessories accessories = findAccessories(asset, geometry);
  const PreparedMesh prepared =
      figureOf(geometry, accessories.empty() ? geometry.triangles : bodyTriangles(geometry, accessories)).prepared;
  AutoRig rig = rigWithTemplate(prepared.mesh, {}, progress);
  if (rig.isAbstained || rig.matches.empty()) return std::nullopt;
  for (Joint& joint : rig.skeleton.joints) {
    joint.rest.translation = joint.parent ? Vec3(prepared.frame.scale * joint.rest.translation)
                                          : prepared.frame.toSource(joint.rest.translation);
  }
  return FittedSkeleton{std::move(rig.skeleton), rig.matches.front().name, rig.matches.front().confidence};
}

std::vector<JointLandmark> commonLandmarks(const Skeleton& source, const Skeleton& target) {
  const std::vector<Affine> globals = restGlobals(target);
  std::vector<JointLandmark> landmarks;
  for (const JointPair& pair : commonJoints(source, target)) {
    landmarks.push_back({pair.source, globals[pair.target].translation()});
  }
  return landmarks;
}

std::vector<JointLandmark> landmarksByTemplate(const Skeleton& source, const Skeleton& inSource,
                                               const Skeleton& inTarget, double size) {
  const std::vector<Affine> globals = restGlobals(source), there = restGlobals(inSource), goal = restGlobals(inTarget);
  std::vector<JointLandmark> ofTemplate;
  for (Index j = 0; j < inSource.jointCount(); ++j) {
    if (const auto same = inTarget.find(inSource.joints[j].name)) ofTemplate.push_back({j, goal[*same].translation()});
  }
  const LimbAlignment alignment = alignLimbs(inSource, there, ofTemplate);
  std::vector<JointLandmark> landmarks;
  for (const JointPair& pair : commonJoints(source, inSource)) {
    const Vec3 position = globals[pair.source].translation();
    const bool isWrong = (position - there[pair.target].translation()).norm() > kTemplateIsWrong * size;
    landmarks.push_back(
        {pair.source, isWrong ? alignment.positions[pair.target] : alignment.maps[pair.target] * position});
  }
  return landmarks;
}

}  // namespace limber
