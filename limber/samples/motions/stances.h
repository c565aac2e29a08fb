// Stances of the sample person, from their parts.
#pragma once

#include "limber/samples/figure.h"

namespace limber {

// On the ground: toes where they are when the ankle of the flat foot is `side` from the middle, the heel lifted so far
// that the foot's pitch is `pitch`. Metres and radians, here and below.
FootPose planted(double side, double pitch = 0);

// In the air, with hanging toes.
FootPose lifted(double side, double height, double pitch);

inline constexpr ArmPose kHanging{.raise = 0.14, .elbow = 0.25};

// Both sides the same; arms hang unless they are told otherwise.
Stance both(const Vec3& pelvis, const FootPose& foot, const ArmPose& arm = kHanging);

// Pitches of the trunk.
Stance leaning(Stance stance, double hips, double chest, double head);

}  // namespace limber
