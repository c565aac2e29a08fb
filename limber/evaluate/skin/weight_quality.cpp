#include "limber/evaluate/skin/weight_quality.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "limber/core/disjoint_sets.h"
#include "limber/evaluate/skin/weight_metrics.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/surface/surface_edges.h"

namespace limber {

namespace {

constexpr float kFollows = 1.0f / 256;

// Each slot of each vertex is an element; those of one joint at both ends of an edge are united.
DisjointSets regionsOf(const SkinWeights& weights, const std::vector<VertexPair>& edges) {
  DisjointSets regions(weights.weights.size());
  for (const auto& [a, b] : edges) {
    for (Index k = 0; k < weights.slots; ++k) {
      if (!(weights.weightsOf(a)[k] > kFollows)) continue;
      for (Index l = 0; l < weights.slots; ++l) {
        if (weights.weightsOf(b)[l] > kFollows && weights.jointsOf(b)[l] == weights.jointsOf(a)[k]) {
          regions.unite(a * weights.slots + k, b * weights.slots + l);
        }
      }
    }
  }
  return regions;
}

double islandFraction(const SkinnedModel& model, const std::vector<VertexPair>& edges) {
  const SkinWeights& weights = model.weights;
  DisjointSets regions = regionsOf(weights, edges);
  const std::vector<Index> pieces = vertexComponents(model.mesh);
  const std::vector<double> areas = vertexAreas(model.mesh);
  std::vector<double> regionWeight(weights.weights.size(), 0);  // by a region, at the element that names it
  double all = 0;
  for (Index i = 0; i < regionWeight.size(); ++i) {
    if (!(weights.weights[i] > kFollows)) continue;
    const double own = weights.weights[i] * areas[i / weights.slots];
    regionWeight[regions.find(i)] += own;
    all += own;
  }
  std::map<std::pair<Index, Index>, double> largest;  // of a piece and a joint
  for (Index i = 0; i < regionWeight.size(); ++i) {
    if (!(regionWeight[i] > 0)) continue;
    double& most = largest[{pieces[i / weights.slots], weights.joints[i]}];
    most = std::max(most, regionWeight[i]);
  }
  double connected = 0;
  for (const auto& [where, most] : largest) connected += most;
  return all > 0 ? std::max(0.0, 1 - connected / all) : 0;
}

}  // namespace

WeightQuality measureWeights(const SkinnedModel& model) {
  const std::vector<VertexPair> edges = surfaceEdges(model.mesh).edges;
  WeightQuality result;
  result.islands = islandFraction(model, edges);
  double followers = 0, influences = 0;
  for (Index v = 0; v < model.weights.vertexCount(); ++v) {
    const auto of = model.weights.weightsOf(v);
    const auto count = std::count_if(of.begin(), of.end(), [](float w) { return w > kFollows; });
    influences += static_cast<double>(count);
    followers += count > 0;
  }
  if (followers > 0) result.influences = influences / followers;
  for (const auto& [a, b] : edges) result.roughness += weightDifference(model.weights, a, model.weights, b);
  if (!edges.empty()) result.roughness /= static_cast<double>(edges.size());
  return result;
}

}  // namespace limber
