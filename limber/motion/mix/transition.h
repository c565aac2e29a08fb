// When one motion goes over into another.
#pragma once

#include "limber/motion/mix/mixed_frames.h"

namespace limber {

// Seconds, and frames; 1e-12 to 1e-6; between times that are the same; rounding only.
inline constexpr double kSameTime = 1e-9;

struct Transition {
  StridePhases phases;
  std::vector<MixMoment> moments;  // its frames: the first all of a, the last all of b
};

struct TransitionOptions {
  double seconds = 0.3;            // that it takes at most
  double frameSeconds = 1 / 60.0;  // of the result
  double from = 0;                 // seconds: the first motion is joined of others, of which the last one begins here
};

// The transition that begins within the last second of the first motion that leaves time for it, and within the first
// second of the second motion, of neither more than half of what it lasts longer; after `from` where there is time, and
// of the joined motion's last one no more than half, either. It takes whole frames, no longer than asked for, and no
// longer than either motion. Of all those at the same phase of a step (matchStrides), and where footfalls say nothing
// of any two moments, the one in which a foot is planted in both halfway through, and of these the one with the least
// distance: of the joints in the body's own frame, as they are and as they will be in a tenth of a second if they go on
// so, squared, summed over beginning, middle and end (after Kovar, Gleicher, Pighin 2002, Motion graphs). The weight
// follows the path of least jerk from rest to rest (Flash, Hogan 1985). Throws Error kBadArgument where less than a
// frame is asked for, or one of them lasts no longer.
Transition findTransition(const MixBody& body, const MixMotion& a, const MixMotion& b,
                          const TransitionOptions& options);

}  // namespace limber
