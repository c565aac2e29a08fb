#include "limber/skeleton/skin_weights.h"

#include <algorithm>

namespace limber {

void bindTo(Index joint, Index vertex, SkinWeights& weights) {
  const std::size_t first = std::size_t{vertex} * weights.slots;
  std::fill_n(weights.joints.begin() + first, weights.slots, 0);
  std::fill_n(weights.weights.begin() + first, weights.slots, 0.0f);
  weights.joints[first] = joint;
  weights.weights[first] = 1;
}

SkinWeights expandWeights(const SkinWeights& welded, std::span<const Index> weldedVertex) {
  SkinWeights result;
  result.slots = welded.slots;
  result.joints.resize(weldedVertex.size() * welded.slots);
  result.weights.resize(weldedVertex.size() * welded.slots);
  for (std::size_t v = 0; v < weldedVertex.size(); ++v) {
    const std::size_t from = std::size_t{weldedVertex[v]} * welded.slots, to = v * welded.slots;
    std::copy_n(welded.joints.begin() + from, welded.slots, result.joints.begin() + to);
    std::copy_n(welded.weights.begin() + from, welded.slots, result.weights.begin() + to);
  }
  return result;
}

void normalizeWeights(SkinWeights& weights) {
  for (std::size_t v = 0; v < weights.vertexCount(); ++v) {
    float* begin = weights.weights.data() + v * weights.slots;
    float sum = 0;
    for (Index i = 0; i < weights.slots; ++i) sum += begin[i];
    if (!(sum > 0)) continue;
    for (Index i = 0; i < weights.slots; ++i) begin[i] /= sum;
  }
}

}  // namespace limber
