// The weights of all points over bones whose motions are known.
#pragma once

#include <vector>

#include "limber/rigging/decomposition/bone_motions.h"
#include "limber/rigging/decomposition/vertex_sequence.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

inline constexpr Index kMaxInfluences = 8;  // of a point

struct FittedWeights {
  SkinWeights weights;         // of #points, slots as asked for
  std::vector<double> errors;  // #points, squared distances to the sequence summed over the frames
};

// Weights that bring each point nearest to where it is in all frames, by linear blend (Le, Deng 2012, section 4.1):
// among the kMaxCandidates bones that fit it best alone, and those of `before`, at most `maxInfluences` (1 to
// kMaxInfluences) by sparseConvexWeights.
//
// before  weights that the points had, over the same bones, at most kMaxInfluences a point; empty for none
// Throws Error kBadArgument for other numbers of influences.
// Parallel over points, the same for any number of threads. Cost: O(#points * #bones * #frames). Memory: 8 bytes a
// point beside the result, 128 a pair of bones, and for each thread 192 a frame and 256 a bone.
FittedWeights fitWeights(const VertexSequence& sequence, const BoneMotions& motions, Index maxInfluences,
                         const SkinWeights& before);

}  // namespace limber
