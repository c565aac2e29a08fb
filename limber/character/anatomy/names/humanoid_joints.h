// Which joints of a skeleton play the bones of a person.
#pragma once

#include <vector>

#include "limber/character/anatomy/skeleton_reading.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// Each bone and each joint at most once, in the order of humanoidBones(). Bones that the file declares
// (Joint::declaredBone) are as it says, where a body can have them (believedSkeleton), and a spine of which it declares
// any joint has no others; the rest are as readAnatomy infers them. The hips are where legs and spine part, or a joint
// above that is named so; of the joints from there to the neck the first is the spine, the one halfway the chest and
// the last the upper chest. Bodies with more than two legs have no human legs, and wings are no arms. Bodies without
// any of it get none. Errors and cost of readAnatomy.
std::vector<HumanoidJoint> humanoidJoints(const SkeletonReading& skeleton);

}  // namespace limber
