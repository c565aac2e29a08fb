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

// First a, which is left as it is up to the transition, then b, turned and moved over the ground so that the body
// continues from its position and heading. findTransition says when; in between both play step by step at a speed that
// goes from one's to the other's, mixFrames makes poses, trajectory and contacts, and feet stay planted
// (plantMixedFeet) until they lift off for the first time after it. A motion that is still (isStill) lasts at least as
// long as its transitions take. Others that are too short for a transition shorten it: to their duration, between two
// others to half of that, so that some of them remains; this is reported to `warnings`, if any ("short-transitions").
// The result's contacts are its own, its name is a's. Throws Error kBadArgument for a transition of less than a frame,
// and as MixBody and MixMotion do.
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
