// A pose among motions: it has no rate, and lasts as long as the others need it to.
#pragma once

#include "limber/motion/mix/planted_feet.h"

namespace limber {

// Whether nothing moves: one key, or keys that are all the same within 1e-4 (metres, components of quaternions).
bool isStill(const Clip& clip);

// Its first pose in frames `frameSeconds` apart, for so many seconds or up to a frame more. When feet are planted is
// left to be read off it. Throws Error kLimit beyond kMaxClipFrames.
ClipWithContacts holdPose(const Skeleton& skeleton, const Clip& clip, double seconds, double frameSeconds);

}  // namespace limber
