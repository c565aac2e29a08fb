// The method "spacetime": one smooth change over the whole motion that puts hands and feet where they have to be.
#pragma once

#include "limber/retarget/retarget_method.h"

namespace limber {

// After Gleicher (Retargetting motion to new characters, 1998): starts from "aligned" and adds displacement curves,
// which are as small and smooth as the constraints of all frames allow, in the least squares sense: planted feet stand,
// no foot is below the ground, hands that touch something in the source touch it (LimbGoals). Since
// it knows what comes, it needs no time to catch up; and a foot that only slows down is held the less the faster it is.
//
// The curves are of feet and hands, not of joint angles as Gleicher's: so the constraints are linear, each curve is one
// banded system (DisplacementCurve), and inverse kinematics makes angles of them frame by frame, as Lee and Shin do (A
// hierarchical approach to interactive motion editing, 1999). The pelvis follows the feet (Pelvis::moveFor), free feet
// go along with it, and both are found a second time. Linear in the number of frames, about 20 us each.
//
// Given up: B-splines of the joint angles, a control point every 0.08 s, by Gauss-Newton steps. They cannot follow what
// planted feet of recordings tremble: feet slid by 0.033 heights/s and sank by 22 mm. Ground as one-sided rows of these
// steps diverged on some motions.
void refineSpacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target);

}  // namespace limber
