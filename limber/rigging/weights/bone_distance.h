// Weights by the distance to bones alone, whatever lies between: what others are measured against, and what is enough
// for models of which nothing else can be told.
#pragma once

#include <span>

#include "limber/rigging/weights/influence_table.h"
#include "limber/rigging/weights/weight_method.h"

namespace limber {

// Every vertex follows the joint of its nearest bone; of equals the lowest.
// mesh, bones, errors  as for all methods (checkWeightArguments). Cost: O(#V #B), in parallel.
WeightResult nearestBoneWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                Progress& progress);

// Envelopes, as character animation has used them without regard to the surface: a bone has full weight within its
// inner radius, and less and less up to its outer one, as the square of the remaining distance. A bone's inner radius
// is the median distance of the vertices that are nearest to it, the outer one twice that. Weights of several bones are
// scaled to a sum of 1; a vertex in no envelope follows its nearest bone, and is counted in the warning
// `outside-envelopes`. Cost: O(#V #B), in parallel.
WeightResult envelopeWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                             Progress& progress);

// Finishes the weights that a method found, where it may have left vertices out: these take the weights of the nearest
// surface that has some (WeightResult::bridged); where none has, each vertex follows its nearest bone, with the warning
// `no-bone-in-sight`. Sums become 1, and pieces whole with PieceMode::kRigid.
WeightResult bridgedWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                            InfluenceTable& table, Progress& progress);

}  // namespace limber
