// Points that move together: where a decomposition begins.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "limber/core/progress.h"
#include "limber/rigging/decomposition/bone_motions.h"
#include "limber/rigging/decomposition/vertex_sequence.h"

namespace limber {

struct MotionClusters {
  std::vector<Index> clusterOf;  // #points
  BoneMotions motions;           // of each cluster, its best rigid motion
  std::vector<double> errors;    // #points, squared distances to it summed over the frames
};

// At most `count` clusters by their rigid motions: one is split after the other, those first that fit worst, at the
// point that fits worst and its neighbours, and each time all points go to the motion that fits them best (Linde, Buzo,
// Gray's codebooks as Le, Deng 2012 and 2014 use them). Fewer than `count` where all points fit. The sequence has a
// box of about unit diagonal.
// Cost: O(#points * #frames * count * log(count)).
MotionClusters motionClusters(const VertexSequence& sequence, Index count, Progress& progress);

// The `count` points nearest to `seed` as they are bound, itself first; only those that `isAllowed`.
std::vector<Index> nearestPoints(const VertexSequence& sequence, Index seed, std::size_t count,
                                 const std::function<bool(Index)>& isAllowed);

// From how many of `points` a new bone gets its motion: a quarter of them, as a seed with all of them would move as
// they do, at most 20 (Le, Deng 2012), at least the three that tell a motion.
inline std::size_t seedPoints(std::size_t points) {
  return std::clamp<std::size_t>(points / 4, 3, 20);
}

}  // namespace limber
