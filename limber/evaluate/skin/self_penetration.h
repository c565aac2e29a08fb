// How much of a character's skin goes into its own body while it moves.
#pragma once

#include <vector>

#include "limber/deform/linear_blend.h"
#include "limber/evaluate/skin/skinned_model.h"
#include "limber/skeleton/pose.h"

namespace limber {

struct SelfPenetrationOptions {
  std::size_t maxFrames = 24;                        // of the motion, evenly from its first to its last
  std::size_t maxVertices = 5000;                    // of the skin, evenly in the file's order
  const Deformer* deformer = &kLinearBlendDeformer;  // by which the skin moves
};

// Fractions, 0 to 1, of those vertices that lie outside the body in bind pose.
struct SelfPenetration {
  double mean = 0, worst = 0;  // over the frames
  std::size_t worstFrame = 0;  // of all the motion's
};

// A vertex is inside where a point a thousandth of the body's size off its surface has a winding number above a half,
// and by more than a half above that in bind pose (open models wind round a point by fractions).
//
// poses  of the model's skeleton
// Throws Error kBadArgument where there is no frame, and as prepareMesh does. Cost: for each frame O(#F log #F).
SelfPenetration measureSelfPenetration(const SkinnedModel& model, const std::vector<Pose>& poses,
                                       const SelfPenetrationOptions& options = {});

}  // namespace limber
