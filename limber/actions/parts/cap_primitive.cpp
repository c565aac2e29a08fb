#include "limber/actions/parts/cap_primitive.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "limber/actions/parts/part_triangles.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/weight_attributes.h"

namespace limber {

namespace {

constexpr Index kSetSize = 4;  // influences in one JOINTS_n

struct Influence {
  Index joint = 0;
  double weight = 0;
};

// Sums of the weights of each joint, strongest first.
std::vector<Influence> strongest(std::vector<Influence> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  std::vector<Influence> joined;
  for (const Influence& influence : all) {
    if (!joined.empty() && joined.back().joint == influence.joint) {
      joined.back().weight += influence.weight;
    } else if (influence.weight > 0) {
      joined.push_back(influence);
    }
  }
  std::stable_sort(joined.begin(), joined.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  if (joined.size() > most) joined.resize(most);
  double sum = 0;
  for (const Influence& influence : joined) sum += influence.weight;
  for (Influence& influence : joined) influence.weight /= sum;
  return joined;
}

}  // namespace

void CapPrimitive::add(const PartCap& cap, const std::vector<ModelVertex>& loop) {
  const Affine& toWorld = geometry_.instances[loop[0].instance].toWorld;
  Vec3 normal = toWorld.linear().transpose() * cap.normal;
  normal = normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::UnitY());
  const auto first = static_cast<Index>(vertices_.size());
  for (const ModelVertex& vertex : loop) vertices_.push_back({{vertex}, normal.cast<float>()});
  if (cap.hasMiddle) vertices_.push_back({loop, normal.cast<float>()});
  const bool mirrored = toWorld.linear().determinant() < 0;
  for (Triangle t : cap.triangles) {
    if (mirrored) std::swap(t[1], t[2]);
    for (Index& v : t) v += first;
    indices_.push_back(t);
  }
}

std::vector<float> CapPrimitive::means(std::map<Index, std::vector<float>> values, Index components) const {
  std::vector<float> result;
  for (const Mixed& vertex : vertices_) {
    for (Index c = 0; c < components; ++c) {
      double sum = 0;
      for (const ModelVertex& of : vertex.of) {
        const std::vector<float>& all = values[of.instance];
        const std::size_t at = std::size_t{of.vertex} * components + c;
        if (at < all.size()) sum += static_cast<double>(all[at]);
      }
      result.push_back(static_cast<float>(sum / static_cast<double>(vertex.of.size())));
    }
  }
  return result;
}

// Zeros where a primitive does not have it.
std::vector<float> CapPrimitive::meansOf(const char* attribute, std::optional<std::size_t> target) const {
  std::map<Index, std::vector<float>> values;
  for (const Mixed& vertex : vertices_) {
    for (const ModelVertex& of : vertex.of) {
      if (values.count(of.instance) > 0) continue;
      const gltf::Primitive& primitive = primitives_[of.instance];
      const gltf::Attributes& attributes = target ? primitive.targets[*target] : primitive.attributes;
      const std::optional<Index> accessor = attributes.find(attribute);
      values[of.instance] = accessor ? readFloats(asset_, *accessor) : std::vector<float>();
    }
  }
  return means(std::move(values), 3);
}

void CapPrimitive::writeWeights(Asset& asset, gltf::Attributes& attributes) const {
  std::map<Index, std::vector<InfluenceSet>> setsOf;
  std::size_t sets = 1;
  for (const Mixed& vertex : vertices_) {
    for (const ModelVertex& of : vertex.of) {
      if (setsOf.count(of.instance) > 0) continue;
      setsOf[of.instance] = readInfluenceSets(asset_, primitives_[of.instance]);
      sets = std::max(sets, setsOf[of.instance].size());
    }
  }
  std::vector<std::vector<std::uint16_t>> joints(sets, std::vector<std::uint16_t>(kSetSize * vertices_.size(), 0));
  std::vector<std::vector<float>> weights(sets, std::vector<float>(kSetSize * vertices_.size(), 0));
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    std::vector<Influence> all;
    for (const ModelVertex& of : vertices_[v].of) {
      for (const InfluenceSet& set : setsOf[of.instance]) {
        for (std::size_t i = kSetSize * of.vertex; i < kSetSize * (std::size_t{of.vertex} + 1); ++i) {
          all.push_back({set.joints[i], static_cast<double>(set.weights[i])});
        }
      }
    }
    all = strongest(std::move(all), sets * kSetSize);
    for (std::size_t i = 0; i < all.size(); ++i) {
      joints[i / kSetSize][kSetSize * v + i % kSetSize] = static_cast<std::uint16_t>(all[i].joint);
      weights[i / kSetSize][kSetSize * v + i % kSetSize] = static_cast<float>(all[i].weight);
    }
  }
  for (std::size_t set = 0; set < sets; ++set) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(joints[set].data());
    attributes.set(fmt::format("JOINTS_{}", set),
                   addAccessor(asset, {static_cast<Index>(vertices_.size()), kSetSize, ComponentType::kU16, false},
                               {bytes, joints[set].size() * sizeof(std::uint16_t)}, kVertexTarget));
    attributes.set(fmt::format("WEIGHTS_{}", set), addFloatAccessor(asset, weights[set], kSetSize, kVertexTarget));
  }
}

gltf::Primitive CapPrimitive::write(Asset& asset, Index material, bool skinned, std::size_t targets) const {
  gltf::Primitive primitive;
  const auto setPositions = [&](gltf::Attributes& attributes, std::optional<std::size_t> target) {
    attributes.set("POSITION", addFloatAccessor(asset, meansOf("POSITION", target), 3, kVertexTarget, true));
  };
  setPositions(primitive.attributes, std::nullopt);
  std::vector<float> normals;
  for (const Mixed& vertex : vertices_) normals.insert(normals.end(), vertex.normal.begin(), vertex.normal.end());
  primitive.attributes.set("NORMAL", addFloatAccessor(asset, normals, 3, kVertexTarget));
  if (skinned) writeWeights(asset, primitive.attributes);
  primitive.indices = addTriangleAccessor(asset, indices_, static_cast<Index>(vertices_.size()));
  primitive.material = material;
  for (std::size_t t = 0; t < targets; ++t) setPositions(primitive.targets.emplace_back(), t);
  return primitive;
}

}  // namespace limber
