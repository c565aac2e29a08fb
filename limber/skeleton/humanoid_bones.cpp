#include "limber/skeleton/humanoid_bones.h"

#include <algorithm>
#include <array>

namespace limber {

namespace {

struct NamedBone {
  std::string_view name, parent;
};

constexpr std::array<NamedBone, 55> kBones = {{
    {"hips", ""},
    {"spine", "hips"},
    {"chest", "spine"},
    {"upperChest", "chest"},
    {"neck", "upperChest"},
    {"head", "neck"},
    {"leftEye", "head"},
    {"rightEye", "head"},
    {"jaw", "head"},
    {"leftUpperLeg", "hips"},
    {"leftLowerLeg", "leftUpperLeg"},
    {"leftFoot", "leftLowerLeg"},
    {"leftToes", "leftFoot"},
    {"rightUpperLeg", "hips"},
    {"rightLowerLeg", "rightUpperLeg"},
    {"rightFoot", "rightLowerLeg"},
    {"rightToes", "rightFoot"},
    {"leftShoulder", "upperChest"},
    {"leftUpperArm", "leftShoulder"},
    {"leftLowerArm", "leftUpperArm"},
    {"leftHand", "leftLowerArm"},
    {"rightShoulder", "upperChest"},
    {"rightUpperArm", "rightShoulder"},
    {"rightLowerArm", "rightUpperArm"},
    {"rightHand", "rightLowerArm"},
    {"leftThumbMetacarpal", "leftHand"},
    {"leftThumbProximal", "leftThumbMetacarpal"},
    {"leftThumbDistal", "leftThumbProximal"},
    {"leftIndexProximal", "leftHand"},
    {"leftIndexIntermediate", "leftIndexProximal"},
    {"leftIndexDistal", "leftIndexIntermediate"},
    {"leftMiddleProximal", "leftHand"},
    {"leftMiddleIntermediate", "leftMiddleProximal"},
    {"leftMiddleDistal", "leftMiddleIntermediate"},
    {"leftRingProximal", "leftHand"},
    {"leftRingIntermediate", "leftRingProximal"},
    {"leftRingDistal", "leftRingIntermediate"},
    {"leftLittleProximal", "leftHand"},
    {"leftLittleIntermediate", "leftLittleProximal"},
    {"leftLittleDistal", "leftLittleIntermediate"},
    {"rightThumbMetacarpal", "rightHand"},
    {"rightThumbProximal", "rightThumbMetacarpal"},
    {"rightThumbDistal", "rightThumbProximal"},
    {"rightIndexProximal", "rightHand"},
    {"rightIndexIntermediate", "rightIndexProximal"},
    {"rightIndexDistal", "rightIndexIntermediate"},
    {"rightMiddleProximal", "rightHand"},
    {"rightMiddleIntermediate", "rightMiddleProximal"},
    {"rightMiddleDistal", "rightMiddleIntermediate"},
    {"rightRingProximal", "rightHand"},
    {"rightRingIntermediate", "rightRingProximal"},
    {"rightRingDistal", "rightRingIntermediate"},
    {"rightLittleProximal", "rightHand"},
    {"rightLittleIntermediate", "rightLittleProximal"},
    {"rightLittleDistal", "rightLittleIntermediate"},
}};

}  // namespace

std::span<const std::string_view> humanoidBones() {
  static const std::vector<std::string_view> kNames = [] {
    std::vector<std::string_view> names;
    for (const NamedBone& bone : kBones) names.push_back(bone.name);
    return names;
  }();
  return kNames;
}

std::optional<std::string_view> humanoidParent(std::string_view bone) {
  const auto found =
      std::find_if(kBones.begin(), kBones.end(), [&](const NamedBone& each) { return each.name == bone; });
  if (found == kBones.end() || found->parent.empty()) return std::nullopt;
  return found->parent;
}

std::vector<HumanoidJoint> jointsCalledAsBones(const Skeleton& skeleton) {
  std::vector<HumanoidJoint> joints;
  for (const NamedBone& bone : kBones) {
    if (const std::optional<Index> joint = skeleton.find(bone.name)) joints.push_back({bone.name, *joint, 1});
  }
  return joints;
}

std::vector<HumanoidJoint> declaredJoints(const Skeleton& skeleton) {
  std::vector<HumanoidJoint> joints;
  for (const NamedBone& bone : kBones) {
    const auto found = std::find_if(skeleton.joints.begin(), skeleton.joints.end(),
                                    [&](const Joint& joint) { return joint.declaredBone == bone.name; });
    if (found != skeleton.joints.end())
      joints.push_back({bone.name, static_cast<Index>(found - skeleton.joints.begin()), 1});
  }
  return joints;
}

}  // namespace limber
