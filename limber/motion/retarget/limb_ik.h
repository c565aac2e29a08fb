// The method "limb-ik": joint angles first, then each limb is solved for where its hand or foot has to be.
#pragma once

#include <memory>

#include "limber/motion/retarget/retarget_method.h"

namespace limber {

// Starts from "aligned" and corrects limbs by inverse kinematics (Koerner; the solver by name: two-bone is the fast
// one):
//   feet   planted in the source stay where they came down, by their toes while the heel is up; they never go below the
//          ground; the pelvis sinks as far as a planted leg would else be too short, and turns less where hips are
//          wide for the legs
//   hands  between where their turned bones bring them and where the source's are, scaled (options.reach); hands that
//          are close together or close to the head in the source are so in the result
// Feet and hands keep their orientation. Nothing jumps when contacts come and go. Between equal skeletons the motion
// stays as it is.
std::unique_ptr<FrameRetargeter> makeLimbIk(const RetargetSetup& setup);

}  // namespace limber
