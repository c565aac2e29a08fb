// What inverse kinematics is asked for, and what it answers.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "limber/skeleton/pose.h"

namespace limber {

// Where a joint, the effector, shall be. Positions and orientations are in the space of the skeleton's globals.
struct IkTarget {
  Index joint = 0;                  // its origin goes to `position`
  Vec3 position = Vec3::Zero();     // metres
  std::optional<Quat> orientation;  // global rotation of the joint; none: as it comes
  double weight = 1;                // above 0, against targets of the same priority
  int priority = 0;                 // 0 first; a later one gets what the earlier leave free
  std::optional<Index> base;        // the highest joint that may turn for this target; none: the root above
  std::optional<Vec3> pole;         // two-bone: the point to which the middle joint bends
};

// What a root joint (without parent) may do besides turning, where it is a base.
enum class RootMotion {
  kFixed,      // neither moves nor turns
  kTurn,       // turns about itself, like every other joint
  kTranslate,  // turns and moves
};

struct IkOptions {
  Index maxIterations = 200;     // of one attempt
  double tolerance = 1e-4;       // reached: nearer than this fraction of the length from base to effector
  double angleTolerance = 1e-3;  // reached: orientation nearer than this, radians
  double angleWeight = 0.25;     // a radian of error counts as this fraction of the length from base to effector
  RootMotion rootMotion = RootMotion::kTurn;

  // Further attempts, from start poses ever nearer to the best one found, where the first is trapped; the first of them
  // only nudges. One that still gained when its iterations were used up is gone on with instead. 0 while dragging:
  // another attempt may find another pose than the last frame's.
  Index restarts = 8;
  std::uint64_t seed = 1;

  // Jacobian methods: of all poses that serve the targets, one near `reference` (none: the rest pose), approached by
  // this fraction in each iteration (Choi, Ko: Online motion retargetting, 1999). 0: off.
  double referenceGain = 0;
  std::optional<Pose> reference;
};

enum class IkOutcome {
  kReached,
  kOutOfReach,  // further from the base than the bones are long, or too near for a long bone to fold: no pose reaches
  kStuck,       // not reached: conflicting targets, blocking limits, or iterations used up
};

struct IkTargetResult {
  double distance = 0;  // left, metres
  double angle = 0;     // left, radians; 0 for a target without orientation
  IkOutcome outcome = IkOutcome::kStuck;
};

struct IkResult {
  std::vector<IkTargetResult> targets;  // in the order of the targets asked for
  Index iterations = 0;                 // of all attempts
  Index restarts = 0;                   // attempts after the first

  bool reached() const {
    for (const IkTargetResult& target : targets) {
      if (target.outcome != IkOutcome::kReached) return false;
    }
    return true;
  }
};

}  // namespace limber
