// Two motions at once: a walk and a run as a jog.
#pragma once

#include <optional>

#include "limber/core/error.h"
#include "limber/motion/mix/planted_feet.h"

namespace limber {

struct BlendOptions {
  double weight = 0.5;              // 0 to 1: 0 is a, 1 is b
  std::optional<double> frameRate;  // of the result; none: the higher one of both
};

// The motions step by step (matchStrides) over the longest span that they have in common, where a motion that loops is
// repeated without end, and the result loops as well if both do; the whole of both where one of them has no footfalls;
// one that is still (isStill) lasts as long as the other. Time goes as fast as the blend of their steps a second
// (Kovar, Gleicher 2003), so that of two walks that differ in speed alone the blend has the blend of their speeds.
// mixFrames makes poses, trajectory and contacts, feet stay planted (plantMixedFeet). The result's contacts are its
// own, its name is a's. Over the joints of `skeleton`, of which both clips and the feet are. `warnings`, if any,
// receives motions that are too unlike to go in step, more than four times as fast as each other ("unlike-rates").
// Throws Error kBadArgument where the weight is not within [0, 1], kLimit for what would take more than kMaxClipFrames,
// and as MixBody and MixMotion do.
ClipWithContacts blendMotions(const Skeleton& skeleton, const ClipWithContacts& a, const ClipWithContacts& b,
                              const BlendOptions& options = {}, Warnings* warnings = nullptr);

}  // namespace limber
