#include "limber/document/scene/blend_shapes.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/shape_name.h"

namespace limber {

namespace {

constexpr double kNoOffset = 1e-6;

void addOffsets(const Asset& asset, const PrimitiveInstance& instance, Index accessor, BlendShape& shape) {
  const std::vector<float> values = readFloats(asset, accessor);
  const Eigen::Matrix3f toWorld = instance.toWorld.linear().cast<float>();
  for (std::size_t v = 0; v < instance.vertexCount && 3 * v + 2 < values.size(); ++v) {
    shape.offsets[instance.firstVertex + v] = toWorld * Vec3f(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
  }
}

bool moves(const BlendShape& shape, const PrimitiveInstance& instance, float least) {
  const auto begin = shape.offsets.begin() + instance.firstVertex;
  return std::any_of(begin, begin + instance.vertexCount, [&](const Vec3f& o) { return o.norm() > least; });
}

// The first instance of each primitive of a mesh that has no shapes yet, by mesh.
std::map<Index, std::vector<const PrimitiveInstance*>> bareMeshes(const Asset& asset, const Geometry& geometry) {
  std::map<Index, std::vector<const PrimitiveInstance*>> meshes;
  std::set<std::pair<Index, Index>> seen;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const std::vector<gltf::Primitive>& primitives = asset.document.meshes[instance.mesh].primitives;
    const bool isBare =
        std::all_of(primitives.begin(), primitives.end(), [](const auto& p) { return p.targets.empty(); });
    if (isBare && seen.insert({instance.mesh, instance.primitive}).second) meshes[instance.mesh].push_back(&instance);
  }
  // Every primitive of a mesh has as many targets; one that is not shown, or has no positions, cannot have any.
  std::erase_if(meshes, [&](const auto& mesh) {
    return mesh.second.size() != asset.document.meshes[mesh.first].primitives.size();
  });
  return meshes;
}

void addTarget(Asset& asset, const PrimitiveInstance& instance, const BlendShape& shape) {
  const Eigen::Matrix3f toStored = instance.toWorld.linear().inverse().cast<float>();
  std::vector<float> values;
  for (std::size_t v = 0; v < instance.vertexCount; ++v) {
    Vec3f offset = toStored * shape.offsets[instance.firstVertex + v];
    if (!offset.allFinite()) offset.setZero();
    values.insert(values.end(), offset.data(), offset.data() + 3);
  }
  gltf::Attributes target;
  target.set("POSITION", addFloatAccessor(asset, values, 3, kVertexTarget, true));
  asset.document.meshes[instance.mesh].primitives[instance.primitive].targets.push_back(std::move(target));
}

}  // namespace

std::vector<BlendShape> readBlendShapes(const Asset& asset, const Geometry& geometry) {
  std::vector<BlendShape> shapes;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const gltf::Mesh& mesh = asset.document.meshes[instance.mesh];
    const std::vector<gltf::Attributes>& targets = mesh.primitives[instance.primitive].targets;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const std::optional<Index> accessor = targets[t].find("POSITION");
      if (!accessor) continue;
      const std::string name = shapeName(mesh, t);
      auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const BlendShape& s) { return s.name == name; });
      if (shape == shapes.end()) {
        shapes.push_back({name, std::vector<Vec3f>(geometry.positions.size(), Vec3f::Zero())});
        shape = std::prev(shapes.end());
      }
      addOffsets(asset, instance, *accessor, *shape);
    }
  }
  return shapes;
}

std::vector<std::string> addBlendShapes(Asset& asset, const Geometry& geometry, const std::vector<BlendShape>& shapes) {
  Box box;
  for (const Vec3f& p : geometry.positions) box.add(p.cast<double>());
  const auto least = static_cast<float>(kNoOffset * box.diagonal());
  std::set<std::string> added;
  for (const auto& [mesh, instances] : bareMeshes(asset, geometry)) {
    Json names = Json::array();
    for (const BlendShape& shape : shapes) {
      if (std::none_of(instances.begin(), instances.end(), [&](const auto* i) { return moves(shape, *i, least); })) {
        continue;
      }
      for (const PrimitiveInstance* instance : instances) addTarget(asset, *instance, shape);
      names.push_back(shape.name);
      added.insert(shape.name);
    }
    if (names.empty()) continue;
    gltf::Mesh& shaped = asset.document.meshes[mesh];
    shaped.weights.assign(names.size(), 0);
    Json& extras = shaped.extras.change();
    if (!extras.is_object()) extras = Json::object();
    extras["targetNames"] = std::move(names);
  }
  std::vector<std::string> inOrder;
  for (const BlendShape& shape : shapes) {
    if (added.count(shape.name) > 0) inOrder.push_back(shape.name);
  }
  return inOrder;
}

}  // namespace limber
