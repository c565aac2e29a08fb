// Bones, their motions and smooth weights out of a mesh that moves.
#pragma once

#include <optional>

#include "limber/core/progress.h"
#include "limber/rigging/decomposition/bone_motions.h"
#include "limber/rigging/decomposition/vertex_sequence.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

struct DecompositionOptions {
  std::optional<Index> bones;  // at most so many, 1 to kMaxBones; none: as few as the tolerance asks for
  Index maxInfluences = 4;     // 1 to 8
  int iterations = 20;         // of weights and motions in turn, 1 or more
  double tolerance = 0.002;  // 0 or more, of the diagonal of the rest pose's box: the error at which bones are enough,
                             // where their number is not given
};

// Where a point bound at p is in frame f: the sum over its bones b of weight * motions.of(b)[f] * (p, 1).
struct Decomposition {
  BoneMotions motions;
  SkinWeights weights;  // of #points; every bone has some
  double error = 0;     // root mean square over points and frames, of the diagonal of the rest pose's box
};

inline constexpr Index kMaxBones = 512;

// Smooth skinning decomposition with rigid bones (Le, Deng 2012): clusters of rigid motion (motionClusters), then
// weights (fitWeights) and motions (fitMotions) in turn; a bone that came to nearly nothing is reseeded where the error
// is largest, and of all iterations the one of least error is the result. Without a number of bones the counts 2, 4, 8,
// ... are tried until the error is within the tolerance or twice the bones take less than a tenth of it away, then
// those between.
//
// The sequence is taken over: its frames are centred and scaled where they lie. One point and one frame at least, in
// any unit and at any position. Throws Error kBadData where the rest pose has no size, a position is not finite, or one
// is farther away than 1e19 diagonals of the rest pose; kBadArgument for options out of range. Parallel, the same for
// any number of threads. Memory beside the sequence: 100 bytes a point at 4 influences (+16 an influence), 96 a bone
// and frame, 256 a pair of bones.
Decomposition decomposeSkin(VertexSequence sequence, const DecompositionOptions& options, Progress& progress);

}  // namespace limber
