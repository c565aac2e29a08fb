// The method "spacetime": one smooth change over the whole motion that puts hands and feet where they have to be.
#pragma once

#include "limber/motion/retarget/retarget_method.h"

namespace limber {

// After Gleicher (Retargetting motion to new characters, 1998): starts from "aligned" and changes it as little and as
// smoothly as the constraints of all frames allow, in the least squares sense. Planted feet keep their position, the
// less firmly the faster the source's own foot moves there; no foot is below the ground; no leg is stretched beyond its
// length; hands that touch something in the source touch it (HandGoals). Since it knows what comes, it needs no time to
// catch up.
//
// The unknowns are displacements of the pelvis, the feet and the shoulders, not joint angles as Gleicher's: so the
// constraints are linear, with the directions of legs' bones to first order, all feet and frames are one banded system
// (LeastChanges), and inverse kinematics makes angles of it frame by frame, as Lee and Shin do (A hierarchical approach
// to interactive motion editing, 1999). Legs that are driven by their feet start from where their feet are driven.
// Linear in the number of frames, about 20 us each; motions of more than a thousand frames in parts of about that many.
//
// Given up: B-splines of the joint angles, a control point every 0.08 s, by Gauss-Newton steps. They cannot follow
// what planted feet of recordings tremble: feet slid by 0.033 heights/s and sank by 22 mm. Ground as one-sided rows of
// these steps diverged on some motions. A displacement curve for each foot, planned before and after a pelvis that
// follows the feet: jerk was up to 4.3 times that of "aligned".
void refineSpacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target);

}  // namespace limber
