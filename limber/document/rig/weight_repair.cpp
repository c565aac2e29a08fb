#include "limber/document/rig/weight_repair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/rig/weight_attributes.h"

namespace limber {

namespace {

bool isWeight(float number) {
  return number >= 0 && std::isfinite(number);
}

// The accessors WEIGHTS_0, WEIGHTS_1, ... of a primitive.
using WeightSets = std::vector<Index>;

WeightSets weightSetsOf(const gltf::Primitive& primitive) {
  WeightSets sets;
  while (const auto accessor = primitive.attributes.find(fmt::format("WEIGHTS_{}", sets.size()))) {
    sets.push_back(*accessor);
  }
  return sets;
}

// Clean weights for those of a vertex's that are none; what is left of these sums to 1. Returns how many there were.
std::size_t cleanRow(std::vector<std::vector<float>>& sets, std::size_t vertex) {
  std::size_t bad = 0;
  double sum = 0;
  const auto forEach = [&](const auto& change) {
    for (std::vector<float>& set : sets) {
      for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) change(set[i]);
    }
  };
  forEach([&](float& weight) {
    if (!isWeight(weight)) {
      weight = 0;
      ++bad;
    }
    sum += double{weight};
  });
  if (bad > 0 && sum > 0) forEach([&](float& weight) { weight = static_cast<float>(weight / sum); });
  return bad;
}

// The same sets where all weights are fine.
WeightSets cleanSets(Asset& asset, const WeightSets& sets, const std::string& where) {
  const bool hasFloats = std::any_of(sets.begin(), sets.end(),
                                     [&](Index set) { return accessorInfo(asset, set).type == ComponentType::kF32; });
  if (!hasFloats) return sets;
  std::vector<std::vector<float>> weights;
  for (const Index set : sets) weights.push_back(readFloats(asset, set));
  std::size_t bad = 0;
  for (std::size_t v = 0; 4 * v < weights[0].size(); ++v) bad += cleanRow(weights, v);
  if (bad == 0) return sets;
  asset.warnings.add("bad-weights", "weights that are negative or not finite count as 0", where, bad);
  WeightSets clean;
  for (const std::vector<float>& set : weights) clean.push_back(addFloatAccessor(asset, set, 4, kVertexTarget));
  return clean;
}

// Primitives that share weights share the clean ones. Does anything change?
bool cleanWeights(Asset& asset) {
  std::map<WeightSets, WeightSets> known;
  bool changes = false;
  for (std::size_t m = 0; m < asset.document.meshes.size(); ++m) {
    for (std::size_t p = 0; p < asset.document.meshes[m].primitives.size(); ++p) {
      gltf::Primitive& primitive = asset.document.meshes[m].primitives[p];
      const WeightSets sets = weightSetsOf(primitive);
      if (sets.empty()) continue;
      const auto [found, isNew] = known.try_emplace(sets, sets);
      if (isNew) found->second = cleanSets(asset, sets, fmt::format("meshes[{}].primitives[{}]", m, p));
      for (std::size_t set = 0; set < sets.size(); ++set) {
        primitive.attributes.set(fmt::format("WEIGHTS_{}", set), found->second[set]);
      }
      changes = changes || found->second != sets;
    }
  }
  return changes;
}

std::size_t unweightedVertices(const Asset& asset, const gltf::Primitive& primitive) {
  const std::vector<InfluenceSet> sets = readInfluenceSets(asset, primitive);
  if (sets.empty()) {
    const auto position = primitive.attributes.find("POSITION");
    return position ? accessorInfo(asset, *position).count : 0;
  }
  std::size_t count = 0;
  for (std::size_t v = 0; 4 * v < sets[0].weights.size(); ++v) {
    const bool hasWeight = std::any_of(sets.begin(), sets.end(), [&](const InfluenceSet& set) {
      const auto row = set.weights.begin() + static_cast<std::ptrdiff_t>(4 * v);
      return 4 * v < set.weights.size() && std::any_of(row, row + 4, [](float weight) { return weight > 0; });
    });
    if (!hasWeight) ++count;
  }
  return count;
}

void tellOfUnweighted(Asset& asset) {
  std::set<Index> skinned;
  for (const gltf::Node& node : asset.document.nodes) {
    if (node.mesh && node.skin) skinned.insert(*node.mesh);
  }
  for (const Index m : skinned) {
    const gltf::Mesh& mesh = asset.document.meshes[m];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      asset.warnings.add("unweighted-vertices", "vertices of skinned meshes follow no joint",
                         fmt::format("meshes[{}].primitives[{}]", m, p), unweightedVertices(asset, mesh.primitives[p]));
    }
  }
}

}  // namespace

void repairWeights(Asset& asset) {
  const AccessorSweep accessors(asset);
  const BufferViewSweep views(asset);
  if (cleanWeights(asset)) {
    accessors.sweep(asset);
    views.sweep(asset);
  }
  tellOfUnweighted(asset);
}

}  // namespace limber
