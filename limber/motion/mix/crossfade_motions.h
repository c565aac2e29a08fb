// One motion after the other as one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/core/error.h"
#include "limber/motion/mix/planted_feet.h"

namespace limber {

struct CrossfadeOptions {
  double seconds = 0.3;             // that the transition takes: a frame or more
  std::optional<double> frameRate;  // of the result; none: the higher one of both
};

// First a, which is left as it is up to the transition, then b, turned and moved over the ground so that the body goes
// on where it is and as it heads. findTransition says when; in between both play step by step at a speed that goes from
// one's to the other's, poses, way and contacts are mixFrames', and feet stay planted (plantMixedFeet) until they lift
// off for the first time after it. A motion that is still (isStill) is held at least as long as its transitions take.
// Others that are too short for one shorten it: to what they last, between two others to half of that, so that there is
// something of them; `warnings`, if any, is told ("short-transitions"). The result's contacts are its own, its name is
// a's. Throws Error kBadArgument for a transition of less than a frame, and as MixBody and MixMotion do.
ClipWithContacts crossfadeMotions(const Skeleton& skeleton, const ClipWithContacts& a, const ClipWithContacts& b,
                                  const CrossfadeOptions& options = {}, Warnings* warnings = nullptr);

struct JoinedMotions {
  ClipWithContacts motion;
  std::vector<TimeSpan> spans;  // while each of them plays: the next one begins before it ends
};

// All of them so, one after the other: at least one.
JoinedMotions joinMotions(const Skeleton& skeleton, std::span<const ClipWithContacts> motions,
                          const CrossfadeOptions& options = {}, Warnings* warnings = nullptr);

}  // namespace limber
