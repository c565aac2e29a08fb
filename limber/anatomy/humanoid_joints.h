// Which joints of a skeleton play the bones of a person.
#pragma once

#include <vector>

#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// As the body is read (readAnatomy): each bone and each joint at most once, in the order of humanoidBones(). The hips
// are where legs and spine part, or above there what is called so; of the joints from there to the neck the first is
// the spine, the one half way the chest and the last the upper chest. Legs of bodies with more than two are no
// people's, nor are wings arms. Bodies without any of it get none. Errors and cost of readAnatomy.
std::vector<HumanoidJoint> humanoidJoints(const Skeleton& skeleton);

}  // namespace limber
