// The direction in which the feet of a body point.
#pragma once

#include <span>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"

namespace limber {

// How far footprints lie before the legs above them, in the mean of the feet on the ground: 1 half their own length, -1
// as much behind. 0 where no foot is on the ground below an upright shin, or none can be distinguished from what it
// rests on.
//
// feet  body space, positions near the ankles
// Cost: three cuts for each foot.
double feetForward(const BodyVolume& body, const AnatomicalFrame& frame, std::span<const Vec3> feet);

}  // namespace limber
