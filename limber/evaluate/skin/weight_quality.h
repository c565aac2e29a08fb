// How well made skin weights are, told without anyone else's.
#pragma once

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// islands     bleeding over gaps: the fraction of all weight, by area, that a joint has where it is cut off from the
//             region of that piece of the surface in which it has the most. 0 to 1. A region is what is joined by edges
//             whose ends both follow the joint by more than 1/256.
// influences  joints that a vertex follows by more than 1/256, mean over the vertices that follow any
// roughness   sum over joints of |w_a - w_b|, 0 to 2, mean over the edges
struct WeightQuality {
  double islands = 0, influences = 0, roughness = 0;
};

// model  welded (weldedModel); each vertex follows a joint by at most one slot. Cost: O((#V + #F) #slots^2).
WeightQuality measureWeights(const SkinnedModel& model);

}  // namespace limber
