// Where a body goes in a clip, without the sway of its steps: what games call root motion.
#pragma once

#include <vector>

#include "limber/skeleton/clip/clip.h"

namespace limber {

struct RootMotionOptions {
  Index body = 0;          // the joint whose trajectory it is: the pelvis
  bool height = false;     // up and down as well as over the ground
  bool heading = false;    // turns about +Y as well
  double smoothing = 0.3;  // seconds, standard deviation of a Gaussian; 0: every movement of the joint
  bool loops = false;      // the clip goes on where it ends as it began, by one stride farther
};

// A rigid motion over time: x -> turn about +Y by `headings` * x + `offsets`. It is the identity where the body is in
// rest pose. Linear between keys, still outside of them.
struct RootTrajectory {
  std::vector<float> times;      // #K seconds, strictly increasing, at least one
  std::vector<Vec3> offsets;     // #K, y is 0 without `height`
  std::vector<double> headings;  // #K radians, unwrapped; empty without `heading`

  Transform at(double seconds) const;
};

// With keys wherever the body's joint or one above it has one, and at least as many a second as the clip's frame rate
// and 30. A Gaussian of 0.3 s leaves a sixth of a sway of one a second in the trajectory, and all of a walk's progress.
// Beyond the ends of a clip it sees the movement turned about the end's own position, so that a constant speed stays
// constant; with `loops` the clip itself, one stride on. Heading is the twist about +Y of the joint's rotation since
// rest pose; where that is not defined (upside down) it stays as it was.
//
// +Y is up. The clip has passed checkClip for the skeleton; throws Error kBadArgument where `body` is no joint of it or
// the smoothing is negative or not finite. Cost: O(duration * smoothing) samples beside sampling the clip 60 times a
// second.
RootTrajectory rootTrajectory(const Skeleton& skeleton, const Clip& clip, const RootMotionOptions& options);

}  // namespace limber
