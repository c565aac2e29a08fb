// Sources of the table: Unreal Engine 5's mannequin (SK_Mannequin: pelvis, spine_01 to spine_05, neck_01 and neck_02,
// index_metacarpal_l), as scripts for it list its bones; Unity's enumeration HumanBodyBones; Godot's
// SkeletonProfileHumanoid (scene/resources/skeleton_profile.cpp, 56 bones); limbs of Blender's rigify metarig (thigh.L,
// shin.L, f_index.01.L), but its torso in words, as spine.003 is a chest in one rig and a neck in another; Mixamo's
// characters (mixamorig:LeftHandIndex1). VRM's names are those of humanoidBones().
//
// Rigify's deform bones and those of Reallusion's Character Creator, AccuRig and ActorCore stand side by side in
// rigify_mapping_data.py of soupday/cc_blender_tools (G3_VERTEX_GROUP_RENAME: DEF-spine.004 is CC_Base_NeckTwist01);
// home-gamejam/stick-game, docs/rigs.md, lists Rigify's of a basic human. Roblox's are those of its character
// specifications (Roblox/creator-docs, content/en-us/art/characters/specifications.md: 15 body parts below Root); what
// an R15 character does not have is called by the joints of the class HumanoidRigDescription (Chest, Neck,
// LeftClavicle, LeftToeBase), and fingers as for Unity. MetaHuman's body has the mannequin's names with 5 joints of the
// spine, 2 of the neck and corrective joints (spine_04_latissimus_l, thigh_correctiveRoot_l), as scripts for it list
// them.
#include "limber/export/bone_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace limber {

namespace {

// Joints of a spine and of a neck that a program numbers: a longer one is not taken for its own.
constexpr std::size_t kMostCounted = 9;
// MetaHuman's spine: the last joint carries neck and clavicles.
constexpr std::size_t kMetaHumanSpine = 5;

struct BoneRow {
  std::string_view vrm;  // without the side
  std::string_view unreal, unity, godot, blender, mixamo, actorCore, roblox;
};

constexpr std::array kBoneRows = {
    BoneRow{"Hips", "pelvis", "Hips", "Hips", "hips", "Hips", "Hip", "LowerTorso"},
    BoneRow{"Spine", "spine_01", "Spine", "Spine", "spine", "Spine", "Waist", "UpperTorso"},
    BoneRow{"Chest", "spine_02", "Chest", "Chest", "chest", "Spine1", "Spine01", "Chest"},
    BoneRow{"UpperChest", "spine_03", "UpperChest", "UpperChest", "upper_chest", "Spine2", "Spine02", "UpperChest"},
    BoneRow{"Neck", "neck_01", "Neck", "Neck", "neck", "Neck", "NeckTwist01", "Neck"},
    BoneRow{"Head", "head", "Head", "Head", "head", "Head", "Head", "Head"},
    BoneRow{"Eye", "eye", "Eye", "Eye", "eye", "Eye", "Eye", "Eye"},
    BoneRow{"Jaw", "jaw", "Jaw", "Jaw", "jaw", "Jaw", "JawRoot", "Jaw"},
    BoneRow{"UpperLeg", "thigh", "UpperLeg", "UpperLeg", "thigh", "UpLeg", "Thigh", "UpperLeg"},
    BoneRow{"LowerLeg", "calf", "LowerLeg", "LowerLeg", "shin", "Leg", "Calf", "LowerLeg"},
    BoneRow{"Foot", "foot", "Foot", "Foot", "foot", "Foot", "Foot", "Foot"},
    BoneRow{"Toes", "ball", "Toes", "Toes", "toe", "ToeBase", "ToeBase", "ToeBase"},
    BoneRow{"Shoulder", "clavicle", "Shoulder", "Shoulder", "shoulder", "Shoulder", "Clavicle", "Clavicle"},
    BoneRow{"UpperArm", "upperarm", "UpperArm", "UpperArm", "upper_arm", "Arm", "Upperarm", "UpperArm"},
    BoneRow{"LowerArm", "lowerarm", "LowerArm", "LowerArm", "forearm", "ForeArm", "Forearm", "LowerArm"},
    BoneRow{"Hand", "hand", "Hand", "Hand", "hand", "Hand", "Hand", "Hand"},
    BoneRow{"ThumbMetacarpal", "thumb_01", "ThumbProximal", "ThumbMetacarpal", "thumb.01", "HandThumb1", "Thumb1",
            "ThumbProximal"},
    BoneRow{"ThumbProximal", "thumb_02", "ThumbIntermediate", "ThumbProximal", "thumb.02", "HandThumb2", "Thumb2",
            "ThumbIntermediate"},
    BoneRow{"ThumbDistal", "thumb_03", "ThumbDistal", "ThumbDistal", "thumb.03", "HandThumb3", "Thumb3", "ThumbDistal"},
    BoneRow{"IndexProximal", "index_01", "IndexProximal", "IndexProximal", "f_index.01", "HandIndex1", "Index1",
            "IndexProximal"},
    BoneRow{"IndexIntermediate", "index_02", "IndexIntermediate", "IndexIntermediate", "f_index.02", "HandIndex2",
            "Index2", "IndexIntermediate"},
    BoneRow{"IndexDistal", "index_03", "IndexDistal", "IndexDistal", "f_index.03", "HandIndex3", "Index3",
            "IndexDistal"},
    BoneRow{"MiddleProximal", "middle_01", "MiddleProximal", "MiddleProximal", "f_middle.01", "HandMiddle1", "Mid1",
            "MiddleProximal"},
    BoneRow{"MiddleIntermediate", "middle_02", "MiddleIntermediate", "MiddleIntermediate", "f_middle.02", "HandMiddle2",
            "Mid2", "MiddleIntermediate"},
    BoneRow{"MiddleDistal", "middle_03", "MiddleDistal", "MiddleDistal", "f_middle.03", "HandMiddle3", "Mid3",
            "MiddleDistal"},
    BoneRow{"RingProximal", "ring_01", "RingProximal", "RingProximal", "f_ring.01", "HandRing1", "Ring1",
            "RingProximal"},
    BoneRow{"RingIntermediate", "ring_02", "RingIntermediate", "RingIntermediate", "f_ring.02", "HandRing2", "Ring2",
            "RingIntermediate"},
    BoneRow{"RingDistal", "ring_03", "RingDistal", "RingDistal", "f_ring.03", "HandRing3", "Ring3", "RingDistal"},
    BoneRow{"LittleProximal", "pinky_01", "LittleProximal", "LittleProximal", "f_pinky.01", "HandPinky1", "Pinky1",
            "LittleProximal"},
    BoneRow{"LittleIntermediate", "pinky_02", "LittleIntermediate", "LittleIntermediate", "f_pinky.02", "HandPinky2",
            "Pinky2", "LittleIntermediate"},
    BoneRow{"LittleDistal", "pinky_03", "LittleDistal", "LittleDistal", "f_pinky.03", "HandPinky3", "Pinky3",
            "LittleDistal"},
};

// Names beside those of the table, divided by blanks; % is the side as the program writes it.
constexpr std::string_view kUnrealOthers =
    "root ik_foot_root ik_foot_% ik_hand_root ik_hand_gun ik_hand_% interaction center_of_mass weapon_% "
    "thigh_twist_01_% thigh_twist_02_% calf_twist_01_% calf_twist_02_% upperarm_twist_01_% upperarm_twist_02_% "
    "lowerarm_twist_01_% lowerarm_twist_02_% index_metacarpal_% middle_metacarpal_% ring_metacarpal_% "
    "pinky_metacarpal_% thigh_twistCor_01_% thigh_twistCor_02_% thigh_correctiveRoot_% thigh_bck_% thigh_fwd_% "
    "thigh_in_% thigh_out_% thigh_bck_lwr_% thigh_fwd_lwr_% calf_twistCor_02_% calf_correctiveRoot_% calf_knee_% "
    "calf_kneeBack_% ankle_bck_% ankle_fwd_% clavicle_out_% clavicle_scap_% clavicle_pec_% spine_04_latissimus_% "
    "upperarm_twistCor_01_% upperarm_twistCor_02_% upperarm_correctiveRoot_% upperarm_bck_% upperarm_fwd_% "
    "upperarm_in_% upperarm_out_% upperarm_bicep_% upperarm_tricep_% lowerarm_correctiveRoot_% lowerarm_bck_% "
    "lowerarm_fwd_% lowerarm_in_% lowerarm_out_% wrist_inner_% wrist_outer_%";
constexpr std::string_view kRigifyOthers =
    "DEF-pelvis.% DEF-breast.% DEF-thigh.%.001 DEF-shin.%.001 DEF-upper_arm.%.001 DEF-forearm.%.001 DEF-palm.01.% "
    "DEF-palm.02.% DEF-palm.03.% DEF-palm.04.%";
constexpr std::string_view kMixamoOthers =
    "mixamorig:HeadTop_End mixamorig:%Toe_End mixamorig:%HandThumb4 mixamorig:%HandIndex4 mixamorig:%HandMiddle4 "
    "mixamorig:%HandRing4 mixamorig:%HandPinky4";
constexpr std::string_view kActorCoreOthers =
    "RL_BoneRoot CC_Base_Pelvis CC_Base_%_ThighTwist01 CC_Base_%_ThighTwist02 CC_Base_%_KneeShareBone "
    "CC_Base_%_CalfTwist01 CC_Base_%_CalfTwist02 CC_Base_%_ToeBaseShareBone CC_Base_%_BigToe1 CC_Base_%_IndexToe1 "
    "CC_Base_%_MidToe1 CC_Base_%_RingToe1 CC_Base_%_PinkyToe1 CC_Base_%_UpperarmTwist01 CC_Base_%_UpperarmTwist02 "
    "CC_Base_%_ElbowShareBone CC_Base_%_ForearmTwist01 CC_Base_%_ForearmTwist02 CC_Base_%_RibsTwist CC_Base_%_Breast "
    "CC_Base_FacialBone CC_Base_UpperJaw CC_Base_Teeth01 CC_Base_Teeth02 CC_Base_Tongue01 CC_Base_Tongue02 "
    "CC_Base_Tongue03";
constexpr std::string_view kRobloxOthers = "Root HumanoidRootPart HumanoidRootNode";

std::string_view stemIn(const BoneRow& row, BoneNames column) {
  switch (column) {
    case BoneNames::kUnreal:
    case BoneNames::kMetaHuman:
      return row.unreal;
    case BoneNames::kUnity:
      return row.unity;
    case BoneNames::kGodot:
      return row.godot;
    case BoneNames::kBlender:
    case BoneNames::kRigify:
      return row.blender;
    case BoneNames::kMixamo:
      return row.mixamo;
    case BoneNames::kActorCore:
      return row.actorCore;
    case BoneNames::kRoblox:
      return row.roblox;
    case BoneNames::kVrm:
      break;
  }
  return row.vrm;
}

std::string_view othersOf(BoneNames column) {
  switch (column) {
    case BoneNames::kUnreal:
    case BoneNames::kMetaHuman:
      return kUnrealOthers;
    case BoneNames::kRigify:
      return kRigifyOthers;
    case BoneNames::kMixamo:
      return kMixamoOthers;
    case BoneNames::kActorCore:
      return kActorCoreOthers;
    case BoneNames::kRoblox:
      return kRobloxOthers;
    case BoneNames::kUnity:
    case BoneNames::kGodot:
      return "Root";
    case BoneNames::kBlender:
    case BoneNames::kVrm:
      break;
  }
  return "";
}

// "leftUpperArm" -> left, UpperArm; "hips" -> none, Hips.
std::pair<Side, std::string> takeSide(std::string_view bone) {
  for (const Side side : kSides) {
    if (bone.starts_with(nameOf(side))) return {side, std::string(bone.substr(nameOf(side).size()))};
  }
  const std::string word(bone);
  return {Side::kCenter, spellStem(std::span(&word, 1), NameStyle::kPascal)};
}

// Of the joint `i` of `count` in the spine, from the hips on; empty where the program does not count them.
std::string spineStem(std::size_t i, std::size_t count, BoneNames column) {
  switch (column) {
    case BoneNames::kUnreal:
      return fmt::format("spine_{:02}", i + 1);
    case BoneNames::kMetaHuman: {  // fewer than its own are spread, so that the last one is its last
      const double apart = count > 1 ? double{kMetaHumanSpine - 1} / static_cast<double>(count - 1) : 0;
      const auto spread = static_cast<std::size_t>(std::lround(apart * static_cast<double>(i)));
      return fmt::format("spine_{:02}", (count < kMetaHumanSpine ? spread : i) + 1);
    }
    case BoneNames::kMixamo:
      return i == 0 ? "Spine" : fmt::format("Spine{}", i);
    case BoneNames::kActorCore:
      return i == 0 ? "Waist" : fmt::format("Spine{:02}", i);
    default:
      return "";
  }
}

std::string neckStem(std::size_t i, BoneNames column) {
  switch (column) {
    case BoneNames::kUnreal:
    case BoneNames::kMetaHuman:
      return fmt::format("neck_{:02}", i + 1);
    case BoneNames::kMixamo:
      return i == 0 ? "Neck" : fmt::format("Neck{}", i);
    case BoneNames::kActorCore:
      return fmt::format("NeckTwist{:02}", i + 1);
    default:
      return "";
  }
}

// Rigify counts from the hips to the head: spine, spine.001, ...
std::string rigifyStem(std::size_t i) {
  return i == 0 ? "spine" : fmt::format("spine.{:03}", i);
}

bool countsTrunk(BoneNames column) {
  return column == BoneNames::kRigify || !spineStem(0, 1, column).empty();
}

// The lists that a program counts, each from its first name on.
std::vector<std::vector<std::string>> countedNames(BoneNames column, NameStyle style) {
  if (!countsTrunk(column)) return {};
  const auto spelled = [&](const auto& stemAt, std::size_t count) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back(spellName(stemAt(i), Side::kCenter, style));
    return names;
  };
  // Hips, spine, neck and head are one list there.
  if (column == BoneNames::kRigify) return {spelled(rigifyStem, 2 * kMostCounted)};
  return {spelled([&](std::size_t i) { return spineStem(i, kMostCounted, column); }, kMostCounted),
          spelled([&](std::size_t i) { return neckStem(i, column); }, kMostCounted)};
}

std::string replacedSide(std::string_view name, std::string_view side) {
  std::string text(name);
  if (const std::size_t at = text.find('%'); at != std::string::npos) text.replace(at, 1, side);
  return text;
}

}  // namespace

std::optional<std::string> boneName(std::string_view vrmBone, BoneNames column, NameStyle style) {
  const auto [side, stem] = takeSide(vrmBone);
  const auto row = std::find_if(kBoneRows.begin(), kBoneRows.end(),
                                [&, &word = stem](const BoneRow& each) { return each.vrm == word; });
  if (row == kBoneRows.end()) return std::nullopt;
  return spellName(stemIn(*row, column), side, style);
}

std::vector<std::string> trunkNames(std::size_t spineJoints, std::size_t neckJoints, BoneNames column,
                                    NameStyle style) {
  std::vector<std::string> names;
  if (!countsTrunk(column)) return names;
  if (column == BoneNames::kRigify) {
    for (std::size_t i = 0; i < spineJoints + neckJoints + 2; ++i) {
      names.push_back(spellName(rigifyStem(i), Side::kCenter, style));
    }
    return names;
  }
  names.push_back(*boneName("hips", column, style));
  for (std::size_t i = 0; i < spineJoints; ++i) {
    names.push_back(spellName(spineStem(i, spineJoints, column), Side::kCenter, style));
  }
  for (std::size_t i = 0; i < neckJoints; ++i) {
    names.push_back(spellName(neckStem(i, column), Side::kCenter, style));
  }
  names.push_back(*boneName("head", column, style));
  return names;
}

std::set<std::string> ownNames(BoneNames column, NameStyle style) {
  std::set<std::string> names;
  constexpr std::array kAllSides = {Side::kCenter, Side::kLeft, Side::kRight};
  for (const BoneRow& row : kBoneRows) {
    for (const Side side : kAllSides) names.insert(spellName(stemIn(row, column), side, style));
  }
  for (std::vector<std::string>& list : countedNames(column, style)) names.insert(list.begin(), list.end());
  std::string_view others = othersOf(column);
  while (!others.empty()) {
    const std::string_view name = others.substr(0, others.find(' '));
    for (const Side side : kSides) names.insert(replacedSide(name, sideWord(side, style)));
    others.remove_prefix(std::min(others.size(), name.size() + 1));
  }
  return names;
}

bool isCountedAsOwn(const std::set<std::string>& names, BoneNames column, NameStyle style) {
  if (column == BoneNames::kMetaHuman) {
    return names.count(spellName(spineStem(kMetaHumanSpine - 1, kMetaHumanSpine, column), Side::kCenter, style)) > 0;
  }
  const std::vector<std::vector<std::string>> lists = countedNames(column, style);
  return std::all_of(lists.begin(), lists.end(), [&](const std::vector<std::string>& list) {
    return std::is_partitioned(list.begin(), list.end(),
                               [&](const std::string& name) { return names.count(name) > 0; });
  });
}

std::string metacarpalName(std::string_view finger, Side side, BoneNames column, NameStyle style) {
  if (column == BoneNames::kRigify) {
    const std::size_t number = finger == "index" ? 1 : finger == "middle" ? 2 : finger == "ring" ? 3 : 4;
    return spellName(fmt::format("palm.{:02}", number), side, style);
  }
  const bool isUnreal = column == BoneNames::kUnreal || column == BoneNames::kMetaHuman;
  const std::string word(isUnreal && finger == "little" ? "pinky" : finger);
  return spellName(spellStem(std::vector<std::string>{word, "metacarpal"}, style), side, style);
}

}  // namespace limber
