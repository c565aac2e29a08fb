// Which joints move a vertex, and how much.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// Per vertex the same number of slots, strongest first; an unused slot is joint 0 with weight 0. Used weights of a
// vertex are positive and sum to 1.
struct SkinWeights {
  Index slots = 0;             // influences per vertex
  std::vector<Index> joints;   // #V * slots
  std::vector<float> weights;  // #V * slots

  Index vertexCount() const { return slots == 0 ? 0 : static_cast<Index>(weights.size() / slots); }
  std::span<const Index> jointsOf(Index v) const { return {joints.data() + std::size_t{v} * slots, slots}; }
  std::span<const float> weightsOf(Index v) const { return {weights.data() + std::size_t{v} * slots, slots}; }
};

// Has a vertex follow one joint alone.
void bindTo(Index joint, Index vertex, SkinWeights& weights);

// Weights of #S source vertices from those of the #V they were welded to. `weldedVertex` holds #S indices below #V.
SkinWeights expandWeights(const SkinWeights& welded, std::span<const Index> weldedVertex);

// Scales the weights of each vertex to a sum of 1; a vertex without weights stays without.
void normalizeWeights(SkinWeights& weights);

}  // namespace limber
