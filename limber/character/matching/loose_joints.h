// What goes with a person's body without hanging on its hips: feet on a root of their own, as rigs for inverse
// kinematics have them.
#pragma once

#include <span>
#include <vector>

#include "limber/character/matching/neutral_pose.h"

namespace limber {

struct LooseJoint {
  Index joint = 0, carrier = 0;  // `joint` rides on `carrier`
  bool matched = true;           // else nothing turns it, and it turns with its carrier
};

// Joints that play a part of the body ride on the part above. Of others each that rests at the position of a joint of
// the body rides on that one, at any depth of its tree (ik_hand_r below ik_hand_gun); else the top of their tree, with
// what is below it, rides on the joint of the body that is nearest in rest pose, if there is one near, unless it rests
// at the position of its parent. Of a map with hips; carriers come before what rides on them, and parents before
// children. `rest` are #J global positions.
std::vector<LooseJoint> looseJoints(const Skeleton& skeleton, const SkeletonMap& map, MapSide side,
                                    std::span<const Vec3> rest);

}  // namespace limber
