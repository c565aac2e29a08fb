#include "limber/document/rig/weight_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/document/gltf/accessor.h"

namespace limber {

namespace {

constexpr Index kSetSize = 4;  // influences in one JOINTS_n

[[noreturn]] void badWeights(Index vertex, const char* what) {
  throw Error(ErrorCode::kBadArgument, what, fmt::format("weights of vertex {}", vertex));
}

// How many joint sets the range needs.
Index setCount(const SkinWeights& weights, const PrimitiveInstance& range) {
  Index used = 1;
  for (Index v = range.firstVertex; v < range.firstVertex + range.vertexCount; ++v) {
    const std::span<const float> row = weights.weightsOf(v);
    for (Index slot = used; slot < weights.slots; ++slot) {
      if (row[slot] > 0) used = slot + 1;
    }
  }
  return (used + kSetSize - 1) / kSetSize;
}

// One vertex's weights made to sum to 1: the rounding of the others goes to the first, which is the strongest.
void normalize(std::span<const float> row, Index vertex, std::span<float> out) {
  double sum = 0;
  for (const float w : row) {
    if (!(w >= 0) || !std::isfinite(w)) badWeights(vertex, "are negative or not finite");
    sum += w;
  }
  if (!(sum > 0)) badWeights(vertex, "are all zero");
  double others = 0;
  for (std::size_t i = 1; i < row.size(); ++i) {
    out[i] = static_cast<float>(row[i] / sum);
    others += out[i];
  }
  out[0] = static_cast<float>(std::max(0.0, 1 - others));
}

struct EncodedWeights {
  std::vector<std::vector<float>> weights;  // a set: #V * 4
  std::vector<std::vector<Index>> joints;
};

EncodedWeights encode(const SkinWeights& weights, const PrimitiveInstance& range, std::span<const Index> skinJointOf) {
  const Index sets = setCount(weights, range);
  EncodedWeights result;
  result.weights.assign(sets, std::vector<float>(std::size_t{range.vertexCount} * kSetSize));
  result.joints.assign(sets, std::vector<Index>(std::size_t{range.vertexCount} * kSetSize));
  std::vector<float> row(weights.slots);
  for (std::size_t v = 0; v < range.vertexCount; ++v) {
    const auto vertex = static_cast<Index>(range.firstVertex + v);
    normalize(weights.weightsOf(vertex), vertex, row);
    for (Index slot = 0; slot < weights.slots; ++slot) {
      if (!(row[slot] > 0)) continue;
      const Index joint = weights.jointsOf(vertex)[slot];
      if (joint >= skinJointOf.size() || skinJointOf[joint] == kNoIndex) badWeights(vertex, "name an unknown joint");
      result.weights[slot / kSetSize][kSetSize * v + slot % kSetSize] = row[slot];
      result.joints[slot / kSetSize][kSetSize * v + slot % kSetSize] = skinJointOf[joint];
    }
  }
  return result;
}

template <typename T>
Index addJoints(Asset& asset, const std::vector<Index>& joints, ComponentType type) {
  const std::vector<T> narrow(joints.begin(), joints.end());
  const AccessorInfo info{static_cast<Index>(joints.size() / kSetSize), kSetSize, type, false};
  return addAccessor(asset, info, {reinterpret_cast<const std::uint8_t*>(narrow.data()), narrow.size() * sizeof(T)},
                     kVertexTarget);
}

}  // namespace

std::vector<InfluenceSet> readInfluenceSets(const Asset& asset, const gltf::Primitive& primitive) {
  std::vector<InfluenceSet> sets;
  for (Index n = 0;; ++n) {
    const std::optional<Index> joints = primitive.attributes.find(fmt::format("JOINTS_{}", n));
    const std::optional<Index> weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", n));
    if (!joints || !weights) return sets;
    InfluenceSet set{readIndices(asset, *joints), readFloats(asset, *weights)};
    if (set.joints.size() != set.weights.size()) return sets;
    sets.push_back(std::move(set));
  }
}

void reportLostInfluences(const gltf::Primitive& primitive, const std::string& mesh, Warnings& warnings) {
  warnings.add("many-influences", "of more than eight joints of a vertex only the strongest move it", mesh,
               primitive.attributes.find("JOINTS_2") ? 1 : 0);
}

void eraseWeightAttributes(gltf::Primitive& primitive) {
  const gltf::Attributes all = primitive.attributes;
  for (const auto& [name, accessor] : all) {
    if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) primitive.attributes.erase(name);
  }
}

gltf::Attributes addWeightAccessors(Asset& asset, const PrimitiveInstance& source, const SkinWeights& weights,
                                    std::span<const Index> skinJointOf, Index skinJointCount) {
  const EncodedWeights encoded = encode(weights, source, skinJointOf);
  gltf::Attributes attributes;
  for (std::size_t set = 0; set < encoded.weights.size(); ++set) {
    attributes.set(fmt::format("JOINTS_{}", set),
                   skinJointCount <= 256 ? addJoints<std::uint8_t>(asset, encoded.joints[set], ComponentType::kU8)
                                         : addJoints<std::uint16_t>(asset, encoded.joints[set], ComponentType::kU16));
    attributes.set(fmt::format("WEIGHTS_{}", set),
                   addFloatAccessor(asset, encoded.weights[set], kSetSize, kVertexTarget));
  }
  return attributes;
}

void writeWeightAttributes(Asset& asset, AttributeTarget target, const PrimitiveInstance& source,
                           const SkinWeights& weights, std::span<const Index> skinJointOf, Index skinJointCount) {
  const gltf::Attributes added = addWeightAccessors(asset, source, weights, skinJointOf, skinJointCount);
  gltf::Primitive& primitive = asset.document.meshes[target.mesh].primitives[target.primitive];
  eraseWeightAttributes(primitive);
  for (const auto& [name, accessor] : added) primitive.attributes.set(name, accessor);
}

}  // namespace limber
