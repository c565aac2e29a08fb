// One motion after the other as one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/motion_mix/planted_feet.h"

namespace limber {

struct CrossfadeOptions {
  double seconds = 0.3;             // that the transition takes: longer than a frame, shorter than each motion
  std::optional<double> frameRate;  // of the result; none: the higher one of both
};

// First a, which is left as it is up to the transition, then b, turned and moved over the ground so that the body goes
// on where it is and as it heads. findTransition says when; in between both play step by step at a speed that goes from
// one's to the other's, poses, way and contacts are mixFrames', and feet stay planted (plantMixedFeet) until they lift
// off for the first time after it. The result's contacts are its own, its name is a's. Throws Error kBadArgument for a
// transition that is too long, and as MixBody and MixMotion do.
ClipWithContacts crossfadeMotions(const Skeleton& skeleton, const ClipWithContacts& a, const ClipWithContacts& b,
                                  const CrossfadeOptions& options = {});

struct JoinedMotions {
  struct Span {
    double from = 0, to = 0;  // seconds of the joined motion
  };
  ClipWithContacts motion;
  std::vector<Span> spans;  // while each of them plays: the next one begins before it ends
};

// All of them so, one after the other: at least one.
JoinedMotions joinMotions(const Skeleton& skeleton, std::span<const ClipWithContacts> motions,
                          const CrossfadeOptions& options = {});

}  // namespace limber
