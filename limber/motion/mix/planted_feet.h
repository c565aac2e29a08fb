// When which foot is planted, by the feet of the character that takes the motion.
#pragma once

#include <span>
#include <vector>

#include "limber/motion/limbs/contacts/contact_track.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {

// Which feet of the target a motion plants and while it does, read off the motion itself (ContactTrack):
// FootSpans::foot is the target's joint. None where the target has no legs that follow the motion's. The setup is that
// between both, the frames are the source's.
std::vector<FootSpans> plantedFeet(const RetargetSetup& setup, const PoseSequence& source);

// The same of a clip; `frameRate` and options as for retargetClip.
std::vector<FootSpans> plantedFeet(const Skeleton& source, const Clip& clip, const Skeleton& target,
                                   const SkeletonMap& map, const RetargetOptions& options, double frameRate);

// Without the flicker of recordings: gaps of less than 0.06 s close, then what is planted for less is left out; no gait
// has either.
std::vector<FootSpans> steadied(std::vector<FootSpans> feet);

}  // namespace limber
