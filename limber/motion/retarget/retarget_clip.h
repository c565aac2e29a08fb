// A whole motion from one skeleton to another.
#pragma once

#include <vector>

#include "limber/motion/limbs/contacts/contact_track.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// Frames; 1e5 and more; bounds memory: 2 GB of poses of 60 joints, nine hours at 120 frames a second.
inline constexpr Index kMaxClipFrames = 4'000'000;

// The clip at even steps from 0 to its duration, as poses. `frameRate` in frames a second, above 0. Throws Error kLimit
// for more than kMaxClipFrames.
PoseSequence sampleFrames(const Skeleton& skeleton, const Clip& clip, double frameRate);

// Poses as a clip with a key at each frame: rotations of joints that turn, translations of joints that move away from
// where they rest. Quaternion signs are chosen for the shortest path from key to key. Where nothing moves, the first
// joint's rotation has the keys, so that the clip lasts as long.
Clip clipOf(const Skeleton& skeleton, const PoseSequence& frames, std::string name);

// The method over all frames of a motion.
PoseSequence retargetFrames(const RetargetMethod& method, const RetargetSetup& setup, const PoseSequence& source);

// All of it: samples `clip` of skeleton `source` at `frameRate` (0: its own), matches by `map`, and gives a clip of the
// same name and length for `target`.
Clip retargetClip(const RetargetMethod& method, const Skeleton& source, const Clip& clip, const Skeleton& target,
                  const SkeletonMap& map, const RetargetOptions& options = {}, double frameRate = 0);

struct ClipWithContacts {
  Clip clip;
  // Feet of the source that are planted, and while they are: none where the method keeps no contacts, or the target has
  // nothing that could.
  std::vector<FootSpans> feet;
};

// Likewise, with the contacts that it keeps. Cost: a forward pass over the source more.
ClipWithContacts retargetClipWithContacts(const RetargetMethod& method, const Skeleton& source, const Clip& clip,
                                          const Skeleton& target, const SkeletonMap& map,
                                          const RetargetOptions& options = {}, double frameRate = 0);

}  // namespace limber
