// Feet that tip less than the source's: long ones, and those that stand flat.
#pragma once

#include <span>

#include "limber/motion/limbs/body/root_motion.h"
#include "limber/motion/limbs/limb.h"

namespace limber {

// Fraction of the source's pitch that the leg's foot takes over: 1 up to 1.3 times the source's length, less the
// longer.
double footPitchFraction(const RetargetSetup& setup, const LegSpec& leg);

// Long feet (LegSpec::footPitch) are as level as that: long toes else go through the ground, and the heels, or the
// hocks of birds, swing further than a leg can follow. People's feet that stand flat (FootContact::flatness) lie as
// they do at rest, as far as they are near it: what tips them is how the source was recorded, and would lift the ankle.
// Soles that look up or to the side stay as they are. `frame` are the globals of `target`; both are brought up to date.
void limitFootPitch(const RetargetSetup& setup, const RootPositioner& root, std::span<const Leg> legs, Pose& target,
                    BodyFrame& frame);

// A foot whose tip (LegSpec::tip) would be below the ground tips less, however high its ankle is. Soles that look up
// stay as they are. `frame` as above.
void keepTipUp(const RetargetSetup& setup, const RootPositioner& root, const LegSpec& leg, Pose& target,
               BodyFrame& frame);

}  // namespace limber
