// The method "online": hands and feet first, joint angles as far as they leave freedom.
#pragma once

#include <memory>

#include "limber/retarget/retarget_method.h"

namespace limber {

// Frame by frame after Choi, Ko (Online motion retargetting, 1999): the ends of the limbs follow where LimbGoals has
// them, and within the null space of that the joint angles imitate the source's. Between equal skeletons the motion
// stays as it is.
//
// Unlike in "limb-ik", a whole limb's joints share the correction, and hands always follow the source's way: their
// distances to the shoulder, scaled by the arm's length. About 30 microseconds for each limb and frame.
std::unique_ptr<FrameRetargeter> makeOnline(const RetargetSetup& setup);

}  // namespace limber
