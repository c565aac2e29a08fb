// What joints are called in other programs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/actions/export/bone_names.h"
#include "limber/actions/export/name_style.h"
#include "limber/character/anatomy/anatomy.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// The name's own words in another spelling. A name that is not written in ASCII stays.
std::string respelled(const std::string& name, NameStyle style);

struct TargetNames {
  std::vector<std::string> joints;  // #J, unique
  // The skeleton has the program's own names already: of the bones of a person that are read off it, at least 8 and at
  // least a third are called as the program calls them.
  bool isOwn = false;
};

// In this order of preference:
// - of a skeleton that has the program's names, the joint's own name: of a bone where it is a name of the program's own
//   skeletons (bone_names.h) and so are all of its limb, finger or trunk; of all other joints whatever it is;
// - the bones of a person as the program calls them, fingers included; joints of the spine and neck are counted where
//   the program counts them; bones of the palm are metacarpals;
// - other parts of a body by one rule: front or hind where there are two pairs, segment, kind, number (a horse's
//   "front_upper_leg", a spider's "upper_leg_2", "tail_03", "wing_01");
// - the joint's own name: as it is where it is a name of the program's own skeletons, else respelled.
//
// Where two joints would have one name, the later of these gets a number. Cost: linear in the joints, after the
// readings that are handed over.
//
// bones  humanoidJoints(skeleton)
TargetNames targetNames(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones,
                        BoneNames column, NameStyle style);

}  // namespace limber
