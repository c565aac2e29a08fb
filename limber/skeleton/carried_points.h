// What of a model each joint carries, as a few points: so that how far a clip moves the surface is measured fast.
#pragma once

#include <span>
#include <vector>

#include "limber/skeleton/skin_weights.h"

namespace limber {

// of  #J, in the joint's own frame (rest pose); lists may be empty
struct CarriedPoints {
  std::vector<std::vector<Vec3>> of;
};

// The corners of a box around the vertices that follow the joint, along their principal axes, and the ends of its bone.
// No vertex that follows one joint alone moves farther than the farthest of that joint's points, whatever affine map
// moves them (a length is convex); one that follows several no farther than these in the mean of its weights. Weights
// below 1/16 count as none: what they carry hardly follows.
//
// positions  #V in rest pose, in the skeleton's space; empty where there is no skin
// weights    #V
CarriedPoints carriedPoints(const Skeleton& skeleton, std::span<const Vec3f> positions, const SkinWeights& weights);

}  // namespace limber
