// Feet that are far longer for their legs than the source's swing less.
#pragma once

#include <span>

#include "limber/retarget/limb.h"
#include "limber/retarget/root_motion.h"

namespace limber {

// Share of the source's pitch that the leg's foot takes over: 1 up to twice the source's length, less the longer.
double footPitchShare(const RetargetSetup& setup, const Leg& leg);

// The feet of those legs (Leg::footPitch) are as level as that: long toes else go through the ground, and the heels,
// or the hocks of birds, swing further than a leg can follow. Soles that look up or to the side stay as they are.
// `frame` are the globals of `target`; both are brought up to date.
void calmLongFeet(const RetargetSetup& setup, const RootPlacer& root, std::span<const Leg> legs, Pose& target,
                  BodyFrame& frame);

}  // namespace limber
