// What joints are called in other programs.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/anatomy/anatomy.h"
#include "limber/export/name_style.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// The columns of the table of names of a person's bones.
enum class BoneNames { kVrm, kUnreal, kUnity, kGodot, kBlender, kMixamo };

// The name's own words in another spelling. A name that is not written in ASCII stays.
std::string respelled(const std::string& name, NameStyle style);

// #J names, unique, in this order of preference:
// - the bones of a person as the program calls them, fingers included; in Unreal and Mixamo the joints of the spine are
//   counted from the hips on and those of the neck from the chest on, in Unreal bones of the palm are metacarpals;
// - other parts of a body by one rule: front or hind where there are two pairs, segment, kind, number
// ("front_upper_leg",
//   "upper_leg_2" of a spider, "tail_03", "wing_01");
// - the joint's own name, respelled.
//
// bones  humanoidJoints(skeleton)
std::vector<std::string> targetNames(const Skeleton& skeleton, const Anatomy& anatomy,
                                     std::span<const HumanoidJoint> bones, BoneNames column, NameStyle style);

}  // namespace limber
