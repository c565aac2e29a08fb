// The method "spacetime": one smooth change over the whole motion that puts hands and feet where they have to be.
#pragma once

#include "limber/retarget/retarget_method.h"

namespace limber {

// After Gleicher (Retargetting motion to new characters, 1998): starts from "aligned" and adds displacement curves,
// uniform cubic B-splines, to the pelvis' way and to the turns of upper and lower limbs. They are as small as the
// constraints of all frames allow, in the least squares sense: feet stand from the first to the last frame of a plant,
// no foot is below the ground, hands that touch something in the source touch it (LimbGoals). Since it knows what
// comes, it needs no time to catch up, and what is between two plants blends from one to the other. Being smooth, the
// curves leave a foot what it slides or sinks within a tenth of a second.
//
// Gauss-Newton steps, each a banded system solved in time linear in the number of frames; about 0.1 ms a frame.
void refineSpacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target);

}  // namespace limber
