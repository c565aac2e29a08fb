// Two motions of a character as one, frame by frame: poses, the trajectory over the ground, planted feet.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/motion/mix/gait/stride_match.h"
#include "limber/motion/mix/mix_motion.h"

namespace limber {

// What one frame of a mix is made of: a moment of one motion, or of both.
struct MixMoment {
  std::optional<double> a, b;  // seconds
  double weight = 0;           // 0 is a, 1 is b
};

// A planted foot in one frame of a mix: the steps from the frame before that its motions take themselves, in the mix's
// heading. They would be nothing if no foot ever slipped.
struct MixedFoot {
  bool planted = false;
  Vec3 ankleStep = Vec3::Zero(), toesStep = Vec3::Zero();  // metres
  double turn = 0;                                         // about +Y, radians
};

struct MixedFrames {
  PoseSequence frames;
  std::vector<MixedFoot> feet;  // of each frame, of each of the body's legs

  // By the legs' ends.
  std::vector<FootSpans> plantedFeet(const MixBody& body) const;
};

// Poses are blended in the body's own frame (GroundFrame), and it moves and turns over the ground at the blend of their
// speeds and turn rates: world positions of two trajectories are not comparable (Kovar, Gleicher 2003, Flexible
// automatic motion blending with registration curves). Legs of both are blended by where knees and feet are and how
// feet are turned: joint angles alone take them elsewhere where legs differ much. A foot is planted from the blend of
// the phases at which it comes down in both to that of those at which it lifts off; a contact without such a partner in
// the other motion, as when one of them is still, is planted where each motion with a weight of a fifth or more plants
// it, but not further than a fifth of the hips' height from where the other one does. Frames are `frameSeconds` apart;
// the first is at `start`, without one between where the motions are.
MixedFrames mixFrames(const MixBody& body, const MixMotion& a, const MixMotion& b, const StridePhases& phases,
                      std::span<const MixMoment> moments, double frameSeconds,
                      const std::optional<GroundFrame>& start = std::nullopt);

}  // namespace limber
