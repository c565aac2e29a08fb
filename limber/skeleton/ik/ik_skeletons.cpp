#include "limber/skeleton/ik/ik_skeletons.h"

#include <string>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/placed_skeleton.h"

namespace limber {

namespace {

// Where a bone begins, in metres; those of a side are the left one's.
struct BoneStart {
  const char* name;
  const char* parent;
  Vec3 position;
};

const BoneStart kTrunk[] = {
    {"hips", "", {0, 0.95, 0}},           {"spine", "hips", {0, 1.05, 0}},
    {"chest", "spine", {0, 1.17, 0}},     {"upperChest", "chest", {0, 1.29, 0}},
    {"neck", "upperChest", {0, 1.44, 0}}, {"head", "neck", {0, 1.52, 0}},
    {"jaw", "head", {0, 1.55, 0.03}},     {"headTop", "head", {0, 1.70, 0}},
};

const BoneStart kSides[] = {
    {"Eye", "head", {0.032, 1.59, 0.07}},
    {"UpperLeg", "hips", {0.09, 0.90, 0}},
    {"LowerLeg", "UpperLeg", {0.09, 0.49, 0}},
    {"Foot", "LowerLeg", {0.09, 0.09, 0}},
    {"Toes", "Foot", {0.095, 0.025, 0.12}},
    {"ToesEnd", "Toes", {0.095, 0.02, 0.19}},
    {"Shoulder", "upperChest", {0.03, 1.40, 0}},
    {"UpperArm", "Shoulder", {0.17, 1.40, 0}},
    {"LowerArm", "UpperArm", {0.44, 1.40, 0}},
    {"Hand", "LowerArm", {0.68, 1.40, 0}},
    {"ThumbMetacarpal", "Hand", {0.71, 1.39, 0.03}},
    {"ThumbProximal", "ThumbMetacarpal", {0.74, 1.385, 0.06}},
    {"ThumbDistal", "ThumbProximal", {0.765, 1.385, 0.08}},
    {"IndexProximal", "Hand", {0.77, 1.40, 0.025}},
    {"IndexIntermediate", "IndexProximal", {0.81, 1.40, 0.028}},
    {"IndexDistal", "IndexIntermediate", {0.835, 1.40, 0.03}},
    {"MiddleProximal", "Hand", {0.772, 1.40, 0}},
    {"MiddleIntermediate", "MiddleProximal", {0.818, 1.40, 0}},
    {"MiddleDistal", "MiddleIntermediate", {0.845, 1.40, 0}},
    {"MiddleEnd", "MiddleDistal", {0.868, 1.40, 0}},
    {"RingProximal", "Hand", {0.766, 1.40, -0.022}},
    {"RingIntermediate", "RingProximal", {0.808, 1.40, -0.024}},
    {"RingDistal", "RingIntermediate", {0.834, 1.40, -0.025}},
    {"LittleProximal", "Hand", {0.755, 1.397, -0.042}},
    {"LittleIntermediate", "LittleProximal", {0.787, 1.397, -0.046}},
    {"LittleDistal", "LittleIntermediate", {0.806, 1.397, -0.048}},
};

}  // namespace

Skeleton straightChain(Index joints, double length) {
  if (joints < 2) throw Error(ErrorCode::kBadArgument, fmt::format("a chain of {} joints", joints));
  Skeleton skeleton;
  for (Index j = 0; j < joints; ++j) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = fmt::format("joint_{:02}", j);
    if (j == 0) continue;
    joint.parent = j - 1;
    joint.rest.translation = Vec3(0, length / (joints - 1), 0);
  }
  return skeleton;
}

Skeleton practiceHumanoid() {
  PlacedSkeleton skeleton;
  for (const BoneStart& bone : kTrunk) skeleton.add(bone.name, bone.parent, bone.position);
  for (const char* side : {"left", "right"}) {
    const double mirror = side[0] == 'l' ? 1 : -1;
    for (const BoneStart& bone : kSides) {
      const std::string parent = bone.parent;
      const bool sided = parent != "head" && parent != "hips" && parent != "upperChest";
      const Vec3 position(mirror * bone.position.x(), bone.position.y(), bone.position.z());
      skeleton.add(side + std::string(bone.name), sided ? side + parent : parent, position);
    }
  }
  return skeleton.take();
}

std::vector<IkTarget> practiceHumanoidTargets(const Skeleton& humanoid) {
  const std::vector<Affine> globals = restGlobals(humanoid);
  std::vector<IkTarget> targets;
  for (const char* name : {"leftHand", "rightHand", "leftFoot", "rightFoot", "head"}) {
    IkTarget target;
    target.joint = humanoid.find(name).value();
    target.position = globals[target.joint].translation();
    targets.push_back(target);
  }
  return targets;
}

}  // namespace limber
