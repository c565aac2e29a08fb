#include "limber/document/vrm/vrm_bones.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "limber/character/anatomy/body_pieces.h"
#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 15> kRequired = {
    "hips",         "spine",         "head",          "leftUpperLeg",  "leftLowerLeg",
    "leftFoot",     "rightUpperLeg", "rightLowerLeg", "rightFoot",     "leftUpperArm",
    "leftLowerArm", "leftHand",      "rightUpperArm", "rightLowerArm", "rightHand"};
bool isRequired(std::string_view bone) {
  return std::find(kRequired.begin(), kRequired.end(), bone) != kRequired.end();
}

// VRM allows such a bone only where the one above is there.
bool needsItsParent(std::string_view bone) {
  if (bone.find("Thumb") != std::string_view::npos) return !bone.ends_with("Metacarpal");
  return bone == "upperChest" || bone.ends_with("Intermediate") || bone.ends_with("Distal");
}

// A thumb of two joints has the first two bones of VRM's three.
std::vector<HumanoidJoint> withThumbsFromTheirFirst(std::vector<HumanoidJoint> joints) {
  using Three = std::array<std::string_view, 3>;
  for (const Three& thumb : {Three{"leftThumbMetacarpal", "leftThumbProximal", "leftThumbDistal"},
                             Three{"rightThumbMetacarpal", "rightThumbProximal", "rightThumbDistal"}}) {
    std::vector<HumanoidJoint*> found;
    for (const std::string_view bone : thumb) {
      const auto joint =
          std::find_if(joints.begin(), joints.end(), [&](const HumanoidJoint& each) { return each.bone == bone; });
      if (joint != joints.end()) found.push_back(&*joint);
    }
    for (std::size_t i = 0; i < found.size(); ++i) found[i]->bone = thumb[i];
  }
  return joints;
}

// Parents before children: what is left out takes along the bones that need it.
std::vector<HumanoidJoint> allowed(const Skeleton& skeleton, const std::vector<HumanoidJoint>& joints,
                                   std::vector<std::string_view>& leftOut) {
  std::map<std::string_view, Index> taken;
  std::vector<HumanoidJoint> kept;
  for (const HumanoidJoint& each : joints) {
    const std::optional<std::string_view> needed = humanoidParent(each.bone);
    std::optional<std::string_view> above = needed;
    while (above && taken.count(*above) == 0) above = humanoidParent(*above);
    const bool hangsThere =
        !above || (isAncestorOrSelf(skeleton, taken[*above], each.joint) && taken[*above] != each.joint);
    if (isRequired(each.bone) || (hangsThere && (!needsItsParent(each.bone) || taken.count(*needed) > 0))) {
      taken[each.bone] = each.joint;
      kept.push_back(each);
    } else {
      leftOut.push_back(each.bone);
    }
  }
  return kept;
}

// Where legs hang on a joint above that of the hips, which lies about there, that one is the hips: it carries all.
void takeHipsThatCarryLegs(const Skeleton& skeleton, std::vector<HumanoidJoint>& joints) {
  constexpr double kNear = 0.5;  // of a thigh's length
  std::map<std::string_view, HumanoidJoint*> found;
  for (HumanoidJoint& joint : joints) found[joint.bone] = &joint;
  for (const char* bone : {"hips", "leftUpperLeg", "leftLowerLeg", "rightUpperLeg"}) {
    if (found.count(bone) == 0) return;
  }
  const auto carriesLegs = [&](Index joint) {
    return isAncestorOrSelf(skeleton, joint, found["leftUpperLeg"]->joint) &&
           isAncestorOrSelf(skeleton, joint, found["rightUpperLeg"]->joint);
  };
  const Index hips = found["hips"]->joint;
  if (carriesLegs(hips)) return;
  const std::optional<Index> above = nearestAbove(skeleton, hips, carriesLegs);
  if (!above) return;
  const std::vector<Vec3> positions = restPositions(skeleton);
  const double thigh = (positions[found["leftLowerLeg"]->joint] - positions[found["leftUpperLeg"]->joint]).norm();
  if ((positions[*above] - positions[hips]).norm() < kNear * thigh) found["hips"]->joint = *above;
}

bool isBelow(std::string_view bone, std::string_view above) {
  for (std::optional<std::string_view> b = bone; b; b = humanoidParent(*b)) {
    if (*b == above) return true;
  }
  return false;
}

// A neck that carries the shoulders as well would turn them where VRM means it to turn the head alone.
void leaveOutCarriersOfOthers(const Skeleton& skeleton, std::vector<HumanoidJoint>& joints,
                              std::vector<std::string_view>& leftOut) {
  const std::vector<HumanoidJoint> all = joints;
  std::erase_if(joints, [&](const HumanoidJoint& each) {
    if (isRequired(each.bone)) return false;
    const bool carriesOthers = std::any_of(all.begin(), all.end(), [&](const HumanoidJoint& other) {
      return isAncestorOrSelf(skeleton, each.joint, other.joint) && !isBelow(other.bone, each.bone);
    });
    if (carriesOthers) leftOut.push_back(each.bone);
    return carriesOthers;
  });
}

std::vector<std::string_view> missingOf(const std::vector<HumanoidJoint>& joints) {
  std::vector<std::string_view> missing;
  for (const std::string_view bone : kRequired) {
    const bool has = std::any_of(joints.begin(), joints.end(), [&](const HumanoidJoint& j) { return j.bone == bone; });
    if (!has) missing.push_back(bone);
  }
  return missing;
}

// What to do about missing bones; `forPeople` where it is a person's skeleton that lacks some.
std::string helpWithout(const Skeleton& skeleton, std::string_view forPeople) {
  const BodyPieces body(skeleton);
  const bool hasArms = body.anatomy.pairsOf(PartKind::kArm) > 0;
  if (body.anatomy.pairsOf(PartKind::kLeg) > 1 || (body.isAnimal() && !hasArms)) {
    return "VRM is for people, and this is read as an animal; glTF, FBX and USD take it as it is";
  }
  return std::string(forPeople);
}

std::vector<HumanoidJoint> checked(const Skeleton& skeleton, std::vector<HumanoidJoint> read, std::string_view name,
                                   std::string_view forPeople, Warnings& warnings) {
  takeHipsThatCarryLegs(skeleton, read);
  std::vector<std::string_view> leftOut;
  std::vector<HumanoidJoint> joints = allowed(skeleton, read, leftOut);
  leaveOutCarriersOfOthers(skeleton, joints, leftOut);
  if (const std::vector<std::string_view> missing = missingOf(joints); !missing.empty()) {
    throw Error(ErrorCode::kUnsupported,
                fmt::format("has no joints for bones that a VRM must have: {}", fmt::join(missing, ", ")),
                std::string(name), helpWithout(skeleton, forPeople));
  }
  warnings.add("vrm-bones",
               fmt::format("bones hang elsewhere than VRM allows and are left out: {}", fmt::join(leftOut, ", ")), {},
               leftOut.size());
  return joints;
}

}  // namespace

std::vector<HumanoidJoint> bonesNamedBy(const gltf::Document& document, const char* extension,
                                        const AssetSkeleton& rig) {
  std::vector<HumanoidJoint> joints;
  for (const HumanoidNode& node : humanoidNodes(document, extension)) {
    const auto joint = std::find(rig.jointNode.begin(), rig.jointNode.end(), node.node);
    if (joint != rig.jointNode.end()) joints.push_back({node.bone, static_cast<Index>(joint - rig.jointNode.begin())});
  }
  return joints;
}

bool hasAllBones(const gltf::Document& document, const char* extension) {
  std::vector<HumanoidJoint> bones;
  for (const HumanoidNode& node : humanoidNodes(document, extension)) bones.push_back({node.bone, node.node});
  return missingOf(bones).empty();
}

std::vector<HumanoidJoint> vrmBones(const Asset& asset, const AssetSkeleton& rig, Warnings& warnings) {
  std::vector<HumanoidJoint> joints = declaredJoints(rig.skeleton);
  if (!missingOf(joints).empty()) joints = withThumbsFromTheirFirst(humanoidJoints(rig.skeleton));
  return checked(rig.skeleton, joints, asset.name,
                 "limber rig --replace-rig --template humanoid gives a person a rig that has all of them", warnings);
}

std::vector<HumanoidJoint> vrmBones(const Skeleton& skeleton, std::string_view name, Warnings& warnings) {
  std::vector<HumanoidJoint> joints = jointsCalledAsBones(skeleton);
  if (!missingOf(joints).empty()) joints = withThumbsFromTheirFirst(humanoidJoints(skeleton));
  return checked(skeleton, joints, name, "limber retarget puts the motion on a person that has all of them", warnings);
}

}  // namespace limber
