// Models put together from parts that turn about pivots, as dolls, robots and animals of boxes are: which joint each
// piece follows.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/weights/piece_rules.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// The joint that each piece follows whole, where every joint that has a bone has a piece of its own; none otherwise.
//
// A part rotates about its joint, so the joint lies in the part or at its end, and in the part that carries it, too. A
// piece can belong to a joint that lies in it or near it, or to the joint that is the parent of two such joints. Of all
// assignments of one piece to each joint the best is the one in which pieces belong to the joints that carry all others
// that they touch (cheapestPairs). Then the other pieces: those that touch joints follow the joint that carries all of
// these; those that touch none, such as ears, follow what they overlap, or what they lie on.
//
// A skeleton whose joints are all children of one does not define which part carries which: there this is inferred from
// the parts that touch each other's joints, from the largest on.
//
// mesh   any; pieces may be open, and turned inside out
// piece  #V, from vertexComponents; pieceCount of them
// bones  from bonesOf(), in the space of the mesh
// None, too, where a bone runs through a piece of another joint, which has to bend there then. A vertex without
// triangles is a piece that follows what is nearest.
//
// Throws Error kCancelled. Cost: O(#F log #F) where joints have no such pieces; else the pairing takes O(joints^2
// pieces) and each round of hanging the others 64 looks a piece and a comparison of boxes for each pair of pieces.
std::optional<PieceBinding> jointsOfPieces(const TriMesh& mesh, std::span<const Index> piece, Index pieceCount,
                                           std::span<const Bone> bones, Progress& progress);

// Whether jointsOfPieces is to be asked: there are several pieces, which may be bound whole, and the bones are
// segments. Balls (handles) move what is round them, whatever it is a part of.
bool mayBeOfParts(Index pieceCount, std::span<const Bone> bones, PieceMode pieces);

// The weights of such a model, each piece bound to its joint; none where it is not one or may not be. Arguments as for
// jointsOfPieces.
std::optional<WeightResult> jointedPieceWeights(const TriMesh& mesh, std::span<const Index> piece, Index pieceCount,
                                                std::span<const Bone> bones, const WeightOptions& options,
                                                Progress& progress);

}  // namespace limber
