// What programs call the bones of a person, and the other names that their own skeletons have: those of the naming
// conventions (limber/character/anatomy/names/naming_convention.h).
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "limber/actions/export/name_style.h"

namespace limber {

// Each is one of the naming conventions.
enum class BoneNames {
  kVrm,
  kUnreal,
  kMetaHuman,
  kUnity,
  kGodot,
  kBlender,
  kRigify,
  kMixamo,
  kActorCore,
  kRoblox,
};

// The bone of VRM ("leftUpperArm") in a program's names, or in its spelling where it has no such bone; none where
// VRM has no such bone.
std::optional<std::string> boneName(std::string_view vrmBone, BoneNames column, NameStyle style);

// The names of the joints from the hips to the head, hips and head included, where the program counts them; empty
// where it does not. Joints of the spine are those between hips and neck, joints of the neck those before the head.
std::vector<std::string> trunkNames(std::size_t spineJoints, std::size_t neckJoints, BoneNames column, NameStyle style);

// The names that the program's own skeletons have: bones, counted joints of spine and neck, twist joints, IK joints,
// metacarpals, ends of bones.
std::set<std::string> ownNames(BoneNames column, NameStyle style);

// Are the joints of spine and neck that are called as the program's ones numbered as it numbers them: without a gap,
// and in MetaHuman's case up to spine_05, which carries the clavicles? `names` are all names of the skeleton.
bool isCountedAsOwn(const std::set<std::string>& names, BoneNames column, NameStyle style);

// Of a finger ("index", "middle", "ring", "little"), the bone of the palm that carries it.
std::string metacarpalName(std::string_view finger, Side side, BoneNames column, NameStyle style);

}  // namespace limber
