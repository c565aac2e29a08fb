// The motions of bones, from the weights with which points follow them.
#pragma once

#include "limber/rigging/decomposition/bone_motions.h"
#include "limber/rigging/decomposition/vertex_sequence.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Improves all motions once: in each frame, bone by bone, to the rotation and translation that bring the points nearest
// to where they are while the other bones stay (Le, Deng 2012, section 4.2: weighted absolute orientation). Points that
// follow one bone alone come out at their best rigid motion at once. A bone without weight stays as it is; where the
// points of a bone leave a choice (they lie on a line) it turns little against `motions`.
//
// weights  of the sequence's points, over the bones of `motions`
// Parallel over frames, the same for any number of threads. Cost: O(#points * slots * #frames). Memory: 96 bytes a bone
// and thread, 128 a pair of bones that share points.
void fitMotions(const VertexSequence& sequence, const SkinWeights& weights, BoneMotions& motions);

// A further bone, whose motion is the best rigid one of these points.
void appendMotionOf(const VertexSequence& sequence, const std::vector<Index>& points, BoneMotions& motions);

}  // namespace limber
