// The method "online": hands and feet first, joint angles as far as they leave freedom.
#pragma once

#include <memory>

#include "limber/retarget/retarget_method.h"

namespace limber {

// Frame by frame after Choi, Ko (Online motion retargetting, 1999): the ends of the limbs, their places and how they
// are turned, are the first task (LimbGoals: planted feet, the ground, hands that touch); the second, in its null
// space, is to imitate the source's joint angles. Damped least squares over each limb's joints. Where feet only ride on
// their legs they stay where joint angles bring them. Between equal skeletons the motion stays as it is.
//
// A frame throws Error kUnsupported where a joint above a limb has a scale that differs between its axes.
std::unique_ptr<FrameRetargeter> makeOnline(const RetargetSetup& setup);

}  // namespace limber
