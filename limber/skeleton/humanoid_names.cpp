#include "limber/skeleton/humanoid_names.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "limber/skeleton/chain.h"
#include "limber/skeleton/humanoid_words.h"

namespace limber {

namespace {

using detail::BodyName;
using detail::BodySide;
using detail::BodyWord;

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

std::string_view boneNamed(std::string_view name) {
  const auto found =
      std::find_if(kBones.begin(), kBones.end(), [&](const NamedBone& bone) { return bone.name == name; });
  return found == kBones.end() ? std::string_view() : found->name;
}

// Reads all names of a skeleton, then gives each bone its joint.
class NameReader {
 public:
  explicit NameReader(const Skeleton& skeleton) : skeleton_(skeleton), depth_(skeleton.jointCount()) {
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      const Joint& joint = skeleton.joints[j];
      depth_[j] = joint.parent ? depth_[*joint.parent] + 1 : 0;
      names_.push_back(detail::readBodyName(joint.name));
      if (const std::string_view bone = boneNamed(joint.name); !bone.empty()) give(bone, j, 1);
    }
  }

  std::vector<HumanoidJoint> read() {
    for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
      arm(side);
      leg(side);
      fingers(side);
    }
    middle();
    std::vector<HumanoidJoint> joints;
    for (const NamedBone& bone : kBones) {
      if (const auto found = given_.find(bone.name); found != given_.end()) joints.push_back(found->second);
    }
    return joints;
  }

 private:
  // A joint plays one bone, and a bone's first joint stays.
  void give(std::string_view bone, Index joint, double confidence) {
    if (taken(joint) || given_.count(bone) > 0) return;
    given_[bone] = {bone, joint, confidence};
  }
  void give(BodySide side, std::string_view bone, std::optional<Index> joint, double confidence) {
    if (!joint) return;
    const std::string name = std::string(side == BodySide::kLeft ? "left" : "right").append(bone);
    give(boneNamed(name), *joint, std::min(confidence, names_[*joint].confidence));
  }
  bool taken(Index joint) const {
    return std::any_of(given_.begin(), given_.end(), [&](const auto& entry) { return entry.second.joint == joint; });
  }
  std::optional<Index> jointOf(std::string_view bone) const {
    const auto found = given_.find(bone);
    return found == given_.end() ? std::nullopt : std::optional(found->second.joint);
  }

  // Joints whose names say so, those nearest the root first.
  std::vector<Index> with(BodyWord word, BodySide side) const {
    std::vector<Index> joints;
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (names_[j].word == word && names_[j].side == side) joints.push_back(j);
    }
    std::stable_sort(joints.begin(), joints.end(), [&](Index a, Index b) { return depth_[a] < depth_[b]; });
    return joints;
  }
  // The first of them that is not taken, below `above` if one of them is.
  std::optional<Index> firstOf(BodyWord word, BodySide side, std::optional<Index> above = {}) const {
    std::optional<Index> first;
    for (const Index joint : with(word, side)) {
      if (taken(joint)) continue;
      if (above && isAncestorOrSelf(skeleton_, *above, joint)) return joint;
      if (!first) first = joint;
    }
    return first;
  }

  // A limb whose joints all have one name ("leg 1", "leg 2", "leg 3"), by their order from the root.
  void inOrder(BodySide side, const std::vector<Index>& joints, std::initializer_list<std::string_view> bones) {
    std::size_t i = 0;
    for (const std::string_view bone : bones) {
      if (i < joints.size()) give(side, bone, joints[i++], 0.6);
    }
  }

  void arm(BodySide side) {
    const std::vector<Index> shoulders = with(BodyWord::kShoulder, side), arms = with(BodyWord::kArm, side);
    const std::optional<Index> collar = firstOf(BodyWord::kCollar, side);
    std::optional<Index> upper = firstOf(BodyWord::kUpperArm, side), shoulder = collar;
    const std::optional<Index> lower = firstOf(BodyWord::kLowerArm, side, upper);
    double sure = 0.95;
    if (!upper && !arms.empty() && !(arms.size() > 2 && !lower)) upper = arms.front();
    if (!upper && arms.size() > 2) {
      if (arms.size() > 3) return inOrder(side, arms, {"Shoulder", "UpperArm", "LowerArm", "Hand"});
      return inOrder(side, arms, {"UpperArm", "LowerArm", "Hand"});
    }
    if (!upper && !shoulders.empty()) {
      upper = shoulders.back();
      if (!collar) sure = 0.85;
    } else if (!collar && !shoulders.empty()) {
      shoulder = shoulders.front();
    }
    give(side, "Shoulder", shoulder, sure);
    give(side, "UpperArm", upper, sure);
    give(side, "LowerArm", lower, sure);
    give(side, "Hand", firstOf(BodyWord::kHand, side, lower), sure);
  }

  void leg(BodySide side) {
    const std::vector<Index> legs = with(BodyWord::kLeg, side), hips = with(BodyWord::kHip, side);
    std::optional<Index> upper = firstOf(BodyWord::kUpperLeg, side), lower = firstOf(BodyWord::kLowerLeg, side, upper);
    double sure = 0.95;
    if (upper && !lower && !legs.empty()) lower = legs.front();
    if (!upper && !hips.empty() && (lower || !legs.empty())) {
      upper = hips.back();
      if (!lower) lower = legs.front();
    }
    if (!upper && lower && !legs.empty()) upper = legs.front();
    if (!upper && legs.size() > 1) {
      // Where one is called the foot, all of these are above it.
      const bool hasFoot = firstOf(BodyWord::kFoot, side).has_value();
      if (!hasFoot) inOrder(side, legs, {"UpperLeg", "LowerLeg", "Foot", "Toes"});
      upper = legs[0];
      lower = hasFoot ? legs.back() : legs[1];
      sure = 0.6;
    }
    give(side, "UpperLeg", upper, sure);
    const std::optional<Index> middle = firstOf(BodyWord::kMiddleLeg, side, upper);
    if (upper && lower && middle && isAncestorOrSelf(skeleton_, *upper, *middle) &&
        isAncestorOrSelf(skeleton_, *middle, *lower)) {
      return hockedLeg(side, *middle, *lower);
    }
    give(side, "LowerLeg", lower, sure);
    // A foot that hangs elsewhere is one that inverse kinematics drove.
    const std::optional<Index> foot = firstOf(BodyWord::kFoot, side, lower);
    const bool below = foot && (!lower || isAncestorOrSelf(skeleton_, *lower, *foot));
    give(side, "Foot", foot, below ? sure : 0.6);
    const std::optional<Index> toes = firstOf(BodyWord::kToes, side, foot);
    give(side, "Toes", toes ? toes : firstOf(BodyWord::kFoot, side, foot), toes ? sure : 0.7);
  }

  // Of three bones the first joint below the thigh bends forward, as a knee does; the next bends back, as the heel of
  // animals that walk on their toes: below it is the foot's bone, and what is called the foot are its toes.
  void hockedLeg(BodySide side, Index knee, Index hock) {
    give(side, "LowerLeg", knee, 0.85);
    give(side, "Foot", hock, 0.85);
    const std::optional<Index> toes = firstOf(BodyWord::kToes, side, hock), foot = firstOf(BodyWord::kFoot, side, hock);
    give(side, "Toes", foot ? foot : toes, 0.7);
  }

  // Three joints of each, from the hand outwards.
  void fingers(BodySide side) {
    struct Finger {
      BodyWord word;
      std::array<std::string_view, 3> bones;
    };
    constexpr std::array<Finger, 5> kFingers = {{
        {BodyWord::kThumb, {"ThumbMetacarpal", "ThumbProximal", "ThumbDistal"}},
        {BodyWord::kIndex, {"IndexProximal", "IndexIntermediate", "IndexDistal"}},
        {BodyWord::kMiddle, {"MiddleProximal", "MiddleIntermediate", "MiddleDistal"}},
        {BodyWord::kRing, {"RingProximal", "RingIntermediate", "RingDistal"}},
        {BodyWord::kLittle, {"LittleProximal", "LittleIntermediate", "LittleDistal"}},
    }};
    for (const Finger& finger : kFingers) {
      std::vector<Index> joints = with(finger.word, side);
      // A thumb of two joints lacks the one in the palm.
      std::size_t bone = finger.word == BodyWord::kThumb && joints.size() == 2 ? 1 : 0;
      for (std::size_t i = 0; i < joints.size() && bone < 3; ++i, ++bone) {
        give(side, finger.bones[bone], joints[i], 0.95);
      }
    }
  }

  void middle() {
    const std::vector<Index> necks = with(BodyWord::kNeck, BodySide::kMiddle);
    if (const auto head = firstOf(BodyWord::kHead, BodySide::kMiddle)) {
      give("head", *head, names_[*head].confidence);
    } else if (necks.size() > 1) {
      give("head", necks.back(), 0.6);
    }
    if (!necks.empty()) give("neck", necks.front(), names_[necks.front()].confidence);
    if (const auto jaw = firstOf(BodyWord::kJaw, BodySide::kMiddle)) give("jaw", *jaw, names_[*jaw].confidence);
    for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
      give(side, "Eye", firstOf(BodyWord::kEye, side), 0.95);
    }
    hips();
    trunk();
  }

  std::optional<Index> lowestAbove(std::optional<Index> a, std::optional<Index> b) const {
    if (!a || !b) return a ? a : b;
    std::optional<Index> up = a;
    while (up && !isAncestorOrSelf(skeleton_, *up, *b)) up = skeleton_.joints[*up].parent;
    return up;
  }

  // Where the legs and the trunk part. A joint called so that carries all of them is believed.
  void hips() {
    const std::vector<Index> trunk = with(BodyWord::kTrunk, BodySide::kMiddle);
    const std::optional<Index> left = jointOf("leftUpperLeg"), right = jointOf("rightUpperLeg");
    const std::optional<Index> neck = jointOf("neck"), head = jointOf("head");
    const std::optional<Index> up = neck ? neck : head ? head : trunk.empty() ? std::nullopt : std::optional(trunk[0]);
    const std::vector<Index> named = with(BodyWord::kHips, BodySide::kMiddle);
    std::optional<Index> fork;
    if (left && right && up) fork = lowestAbove(lowestAbove(left, right), up);
    if (!fork) {
      if (!named.empty()) give("hips", named.front(), names_[named.front()].confidence);
      return;
    }
    for (auto joint = named.rbegin(); joint != named.rend(); ++joint) {
      if (isAncestorOrSelf(skeleton_, *joint, *fork)) return give("hips", *joint, names_[*joint].confidence);
    }
    const bool isLimb = *fork == *left || *fork == *right || *fork == *up;
    if (!isLimb) give("hips", *fork, 0.7);
  }

  // The joints on the way from the hips to the neck, whatever they are called.
  void trunk() {
    const std::optional<Index> hips = jointOf("hips"), neck = jointOf("neck"), head = jointOf("head");
    if (!hips || !(neck || head)) return;
    const Index end = neck ? *neck : *head;
    std::vector<Index> between;
    for (std::optional<Index> up = skeleton_.joints[end].parent; up && *up != *hips;
         up = skeleton_.joints[*up].parent) {
      const BodyWord word = names_[*up].word;
      if (word == BodyWord::kHips) continue;
      if (!taken(*up) || word == BodyWord::kTrunk) between.insert(between.begin(), *up);
    }
    if (!isAncestorOrSelf(skeleton_, *hips, end)) return;
    const auto sure = [&](Index joint) { return names_[joint].word == BodyWord::kTrunk ? 0.9 : 0.7; };
    const std::size_t count = between.size();
    if (count == 0) return;
    give("spine", between[0], sure(between[0]));
    if (count > 1) give("chest", between[count / 2], sure(between[count / 2]));
    if (count > 2) give("upperChest", between[count - 1], sure(between[count - 1]));
  }

  const Skeleton& skeleton_;
  std::vector<Index> depth_;
  std::vector<BodyName> names_;
  std::map<std::string_view, HumanoidJoint> given_;
};

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

std::string_view mirroredBone(std::string_view bone) {
  std::string other(bone);
  if (other.rfind("left", 0) == 0)
    other.replace(0, 4, "right");
  else if (other.rfind("right", 0) == 0)
    other.replace(0, 5, "left");
  const std::string_view found = boneNamed(other);
  return found.empty() ? bone : found;
}

std::vector<HumanoidJoint> humanoidJointsByName(const Skeleton& skeleton) {
  return NameReader(skeleton).read();
}

std::optional<Index> pelvisByName(const Skeleton& skeleton) {
  const std::vector<HumanoidJoint> joints = humanoidJointsByName(skeleton);
  if (joints.empty() || joints.front().bone != "hips") return std::nullopt;
  const Index hips = joints.front().joint;
  const auto spine =
      std::find_if(joints.begin(), joints.end(), [](const HumanoidJoint& joint) { return joint.bone == "spine"; });
  if (spine == joints.end()) return hips;
  for (std::optional<Index> up = skeleton.joints[spine->joint].parent; up && *up != hips;
       up = skeleton.joints[*up].parent) {
    if (detail::readBodyName(skeleton.joints[*up].name).word == BodyWord::kHips) return up;
  }
  return hips;
}

}  // namespace limber
