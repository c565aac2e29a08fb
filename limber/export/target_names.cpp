// Sources of the table: Unreal Engine 5's mannequin (SK_Mannequin: pelvis, spine_01 to spine_05, neck_01 and neck_02,
// index_metacarpal_l), as scripts for it list its bones; Unity's enumeration HumanBodyBones; Godot's
// SkeletonProfileHumanoid (scene/resources/skeleton_profile.cpp, 56 bones); limbs of Blender's rigify metarig (thigh.L,
// shin.L, f_index.01.L), but its torso in words, as spine.003 is a chest in one rig and a neck in another; Mixamo's
// characters (mixamorig:LeftHandIndex1). VRM's names are those of humanoidBones().
#include "limber/export/target_names.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limber/anatomy/body_part.h"
#include "limber/anatomy/joint_words.h"
#include "limber/asset/unique_names.h"

namespace limber {

namespace {

struct BoneRow {
  std::string_view vrm;  // without the side
  std::string_view unreal, unity, godot, blender, mixamo;
};

constexpr std::array kBoneRows = {
    BoneRow{"Hips", "pelvis", "Hips", "Hips", "hips", "Hips"},
    BoneRow{"Spine", "spine_01", "Spine", "Spine", "spine", "Spine"},
    BoneRow{"Chest", "spine_02", "Chest", "Chest", "chest", "Spine1"},
    BoneRow{"UpperChest", "spine_03", "UpperChest", "UpperChest", "upper_chest", "Spine2"},
    BoneRow{"Neck", "neck_01", "Neck", "Neck", "neck", "Neck"},
    BoneRow{"Head", "head", "Head", "Head", "head", "Head"},
    BoneRow{"Eye", "eye", "Eye", "Eye", "eye", "Eye"},
    BoneRow{"Jaw", "jaw", "Jaw", "Jaw", "jaw", "Jaw"},
    BoneRow{"UpperLeg", "thigh", "UpperLeg", "UpperLeg", "thigh", "UpLeg"},
    BoneRow{"LowerLeg", "calf", "LowerLeg", "LowerLeg", "shin", "Leg"},
    BoneRow{"Foot", "foot", "Foot", "Foot", "foot", "Foot"},
    BoneRow{"Toes", "ball", "Toes", "Toes", "toe", "ToeBase"},
    BoneRow{"Shoulder", "clavicle", "Shoulder", "Shoulder", "shoulder", "Shoulder"},
    BoneRow{"UpperArm", "upperarm", "UpperArm", "UpperArm", "upper_arm", "Arm"},
    BoneRow{"LowerArm", "lowerarm", "LowerArm", "LowerArm", "forearm", "ForeArm"},
    BoneRow{"Hand", "hand", "Hand", "Hand", "hand", "Hand"},
    BoneRow{"ThumbMetacarpal", "thumb_01", "ThumbProximal", "ThumbMetacarpal", "thumb.01", "HandThumb1"},
    BoneRow{"ThumbProximal", "thumb_02", "ThumbIntermediate", "ThumbProximal", "thumb.02", "HandThumb2"},
    BoneRow{"ThumbDistal", "thumb_03", "ThumbDistal", "ThumbDistal", "thumb.03", "HandThumb3"},
    BoneRow{"IndexProximal", "index_01", "IndexProximal", "IndexProximal", "f_index.01", "HandIndex1"},
    BoneRow{"IndexIntermediate", "index_02", "IndexIntermediate", "IndexIntermediate", "f_index.02", "HandIndex2"},
    BoneRow{"IndexDistal", "index_03", "IndexDistal", "IndexDistal", "f_index.03", "HandIndex3"},
    BoneRow{"MiddleProximal", "middle_01", "MiddleProximal", "MiddleProximal", "f_middle.01", "HandMiddle1"},
    BoneRow{"MiddleIntermediate", "middle_02", "MiddleIntermediate", "MiddleIntermediate", "f_middle.02",
            "HandMiddle2"},
    BoneRow{"MiddleDistal", "middle_03", "MiddleDistal", "MiddleDistal", "f_middle.03", "HandMiddle3"},
    BoneRow{"RingProximal", "ring_01", "RingProximal", "RingProximal", "f_ring.01", "HandRing1"},
    BoneRow{"RingIntermediate", "ring_02", "RingIntermediate", "RingIntermediate", "f_ring.02", "HandRing2"},
    BoneRow{"RingDistal", "ring_03", "RingDistal", "RingDistal", "f_ring.03", "HandRing3"},
    BoneRow{"LittleProximal", "pinky_01", "LittleProximal", "LittleProximal", "f_pinky.01", "HandPinky1"},
    BoneRow{"LittleIntermediate", "pinky_02", "LittleIntermediate", "LittleIntermediate", "f_pinky.02", "HandPinky2"},
    BoneRow{"LittleDistal", "pinky_03", "LittleDistal", "LittleDistal", "f_pinky.03", "HandPinky3"},
};

std::string_view stemIn(const BoneRow& row, BoneNames column) {
  switch (column) {
    case BoneNames::kUnreal:
      return row.unreal;
    case BoneNames::kUnity:
      return row.unity;
    case BoneNames::kGodot:
      return row.godot;
    case BoneNames::kBlender:
      return row.blender;
    case BoneNames::kMixamo:
      return row.mixamo;
    case BoneNames::kVrm:
      break;
  }
  return row.vrm;
}

// "leftUpperArm" -> left, UpperArm; "hips" -> none, Hips.
std::pair<Side, std::string> takeSide(std::string_view bone) {
  for (const Side side : kSides) {
    if (bone.starts_with(nameOf(side))) return {side, std::string(bone.substr(nameOf(side).size()))};
  }
  const std::string word(bone);
  return {Side::kCenter, spellStem(std::span(&word, 1), NameStyle::kPascal)};
}

class TargetNamer {
 public:
  TargetNamer(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones, BoneNames column,
              NameStyle style)
      : skeleton_(skeleton), anatomy_(anatomy), column_(column), style_(style), wanted_(skeleton.joints.size()) {
    for (const HumanoidJoint& bone : bones) jointOf_[bone.bone] = bone.joint;
  }

  std::vector<std::string> names() {
    nameBones();
    if (column_ == BoneNames::kUnreal || column_ == BoneNames::kMixamo) nameSpine();
    nameMetacarpals();
    for (const Part& part : anatomy_.parts) namePart(part);
    // What is known of the body keeps its name, whatever others are called.
    UniqueNames names;
    for (std::string& name : wanted_) {
      if (!name.empty()) name = names.add(name);
    }
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      if (wanted_[j].empty()) wanted_[j] = names.add(respelled(skeleton_.joints[j].name, style_));
    }
    return std::move(wanted_);
  }

 private:
  std::string spell(std::initializer_list<std::string> words, Side side) const {
    return spellName(spellStem(std::vector<std::string>(words), style_), side, style_);
  }

  void want(Index joint, std::string name) {
    if (wanted_[joint].empty()) wanted_[joint] = std::move(name);
  }

  std::optional<Index> jointOf(std::string_view bone) const {
    const auto found = jointOf_.find(bone);
    return found == jointOf_.end() ? std::nullopt : std::optional(found->second);
  }

  void nameBones() {
    for (const auto& [bone, joint] : jointOf_) {
      const auto [side, stem] = takeSide(bone);
      const auto row = std::find_if(kBoneRows.begin(), kBoneRows.end(),
                                    [&, &word = stem](const BoneRow& each) { return each.vrm == word; });
      if (row != kBoneRows.end()) want(joint, spellName(stemIn(*row, column_), side, style_));
    }
  }

  // The joints strictly between two, from the upper one down; none where the lower one does not hang on it.
  std::vector<Index> between(std::optional<Index> upper, std::optional<Index> lower) const {
    std::vector<Index> joints;
    if (!upper || !lower) return joints;
    std::optional<Index> at = skeleton_.joints[*lower].parent;
    for (; at && *at != *upper; at = skeleton_.joints[*at].parent) joints.push_back(*at);
    if (!at) return {};
    std::reverse(joints.begin(), joints.end());
    return joints;
  }

  // Counted, however many there are.
  void nameSpine() {
    const std::optional<Index> neck = jointOf("neck"), head = jointOf("head");
    const std::vector<Index> spine = between(jointOf("hips"), neck ? neck : head);
    const bool unreal = column_ == BoneNames::kUnreal;
    for (std::size_t i = 0; i < spine.size(); ++i) {
      const std::string stem = unreal   ? fmt::format("spine_{:02}", i + 1)
                               : i == 0 ? std::string("Spine")
                                        : fmt::format("Spine{}", i);
      wanted_[spine[i]] = spellName(stem, Side::kCenter, style_);
    }
    const std::vector<Index> necks = between(neck, head);
    for (std::size_t i = 0; i < necks.size(); ++i) {
      const std::string stem = unreal ? fmt::format("neck_{:02}", i + 2) : fmt::format("Neck{}", i + 1);
      wanted_[necks[i]] = spellName(stem, Side::kCenter, style_);
    }
  }

  void nameMetacarpals() {
    for (const Side side : kSides) {
      for (const char* finger : {"Index", "Middle", "Ring", "Little"}) {
        const std::string sideName(nameOf(side));
        const std::vector<Index> palm = between(jointOf(sideName + "Hand"), jointOf(sideName + finger + "Proximal"));
        if (palm.empty()) continue;
        std::string word(finger);
        word[0] = static_cast<char>(word[0] - 'A' + 'a');
        if (column_ == BoneNames::kUnreal && word == "little") word = "pinky";
        want(palm.back(), spell({word, "metacarpal"}, side));
      }
    }
  }

  // The parts that no person has.
  void namePart(const Part& part) {
    if (part.kind == PartKind::kLeg || part.kind == PartKind::kArm) return nameLimb(part);
    const bool isNamed = part.kind == PartKind::kTail || part.kind == PartKind::kWing || part.kind == PartKind::kFin ||
                         part.kind == PartKind::kEar;
    if (!isNamed) return;
    std::string kind(nameOf(part.kind));
    const std::string pair = part.pair > 0 ? std::to_string(part.pair + 1) : "";
    for (std::size_t i = 0; i < part.joints.size(); ++i) {
      const std::string number = part.joints.size() > 1 ? fmt::format("{:02}", i + 1) : "";
      want(part.joints[i], spell({kind, pair, number}, part.side));
    }
  }

  void nameLimb(const Part& part) {
    const Index pairs = anatomy_.pairsOf(part.kind);
    const std::string kind(nameOf(part.kind));
    std::string place, number;
    if (pairs == 2) place = part.pair == 0 ? "front" : "hind";
    if (pairs > 2 || (pairs == 1 && part.pair > 0)) number = std::to_string(part.pair + 1);
    const bool isArm = part.kind == PartKind::kArm;
    const auto name = [&](std::optional<Index> joint, std::initializer_list<std::string> words) {
      if (!joint) return;
      std::vector<std::string> all = {place};
      all.insert(all.end(), words);
      all.push_back(number);
      want(*joint, spellName(spellStem(all, style_), part.side, style_));
    };
    if (part.upper && part.upper != part.joints.front()) {
      name(part.joints.front(), {isArm || (pairs == 2 && part.pair == 0) ? "shoulder" : "hip"});
    }
    name(part.upper, {"upper", kind});
    name(part.middle, {"lower", kind});
    name(part.hock, {"hock"});
    name(part.end, {isArm ? "hand" : "foot"});
    name(part.toes, {isArm ? "fingers" : "toes"});
  }

  const Skeleton& skeleton_;
  const Anatomy& anatomy_;
  BoneNames column_;
  NameStyle style_;
  std::map<std::string_view, Index> jointOf_;  // by the bone of VRM
  std::vector<std::string> wanted_;            // #J, empty: not named yet
};

}  // namespace

std::string respelled(const std::string& name, NameStyle style) {
  const auto isForeign = [](char c) { return static_cast<unsigned char>(c) > 0x7e; };
  if (std::any_of(name.begin(), name.end(), isForeign)) return name;
  const NameParts parts = partsOfName(name);
  return parts.words.empty() ? name : spellName(spellStem(parts.words, style), parts.side, style);
}

std::vector<std::string> targetNames(const Skeleton& skeleton, const Anatomy& anatomy,
                                     std::span<const HumanoidJoint> bones, BoneNames column, NameStyle style) {
  return TargetNamer(skeleton, anatomy, bones, column, style).names();
}

}  // namespace limber
