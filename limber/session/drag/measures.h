// Figures of a session's current state, by which methods can be compared on a model that has no reference rig.
#pragma once

#include <optional>

#include "limber/evaluate/motion/motion_metrics.h"
#include "limber/session/session.h"

namespace limber {

struct SessionMeasures {
  Index joints = 0;
  double influences = 0;  // joints with a weight above 1/256 at a vertex, mean
  double smoothness = 0;  // sum over joints of |w_a - w_b|, 0 to 2, mean over the triangles' sides
  // In the pose, against the model as bound.
  double stretch = 0;                    // change of sides' length, as a fraction of it, mean
  double volume = 0;                     // enclosed by the surface: 0.1 is a tenth more; 0 where it encloses none
  std::optional<double> targetDistance;  // metres from pinned joints to their targets, worst
  std::optional<MotionMetrics> motion;   // of the chosen clip, where it is a motion between people
};

// Throws Error kBadArgument while nothing is open. Cost: O(#S), and that of measureMotion.
SessionMeasures measureSession(const Session& session);

// {"joints", "influences", "smoothness", "stretch", "volume", "target_distance": or null, "motion": or null, as
// toJson gives it}
Json measuresToJson(const SessionMeasures& measures);

}  // namespace limber
