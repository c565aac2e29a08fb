// Walks the default scene and brings every primitive to world space.
#include "limber/document/scene/geometry.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/core/known_error.h"
#include "limber/core/transform.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/scene/grid_step.h"
#include "limber/document/scene/primitive_triangles.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

namespace {

constexpr std::uint64_t kMaxVertices = kNoIndex - 1;

// One showing of a mesh.
struct MeshInstance {
  Index node, mesh, copy;
  Affine toWorld;
};

// The accessors of a node's EXT_mesh_gpu_instancing, checked; nothing in them has been read yet.
struct GpuInstancing {
  std::optional<Index> translation, rotation, scale;
  Index count = 0;  // 0 where the node does not use it
};

GpuInstancing gpuInstancing(const Asset& asset, Index node) {
  const std::string where = fmt::format("nodes[{}]", node);
  const gltf::Attributes attributes = instancingOf(asset.document.nodes[node], where);
  std::optional<Index> count;
  const auto find = [&](const char* name, Index components) {
    const std::optional<Index> accessor = attributes.find(name);
    if (!accessor) return accessor;
    const std::string location = fmt::format("{}.extensions.{}.{}", where, kInstancingName, name);
    if (*accessor >= asset.document.accessors.size()) failAt(location, "names an accessor that does not exist");
    const AccessorInfo info = accessorInfo(asset, *accessor);
    if (info.components != components) failAt(location, "has the wrong accessor type");
    if (count.value_or(info.count) != info.count) failAt(location, "is not as long as the other attributes");
    count = info.count;
    return accessor;
  };
  GpuInstancing result;
  result.translation = find("TRANSLATION", 3);
  result.rotation = find("ROTATION", 4);
  result.scale = find("SCALE", 3);
  result.count = count.value_or(0);
  return result;
}

// The instances' transforms, relative to the node.
std::vector<Affine> gpuInstances(const Asset& asset, const GpuInstancing& instancing) {
  const auto read = [&](const std::optional<Index>& accessor) {
    return accessor ? readFloats(asset, *accessor) : std::vector<float>();
  };
  const std::vector<float> translations = read(instancing.translation);
  const std::vector<float> rotations = read(instancing.rotation);
  const std::vector<float> scales = read(instancing.scale);

  std::vector<Affine> result(instancing.count);
  for (std::size_t i = 0; i < result.size(); ++i) {
    Transform t;
    if (!translations.empty()) t.translation = Eigen::Map<const Vec3f>(&translations[3 * i]).cast<double>();
    if (!scales.empty()) t.scale = Eigen::Map<const Vec3f>(&scales[3 * i]).cast<double>();
    if (!rotations.empty()) t.rotation.coeffs() = Eigen::Map<const Vec4f>(&rotations[4 * i]).cast<double>();
    t.rotation = t.rotation.norm() > 0 ? t.rotation.normalized() : Quat::Identity();
    result[i] = t.toAffine();
  }
  return result;
}

// Throws Error kLimit before the memory for too many instances is asked for.
std::vector<MeshInstance> meshInstances(const Asset& asset) {
  const SceneGraph graph = readSceneGraph(asset.document);
  const BindPose bindPose = readBindPose(asset, graph);
  const std::vector<gltf::Node>& nodes = asset.document.nodes;
  std::vector<MeshInstance> result;
  std::uint64_t total = 0;
  const auto count = [&](std::uint64_t added) {
    total += added;
    if (total <= read_bounds::kShownInstances.of(nodes.size())) return;
    throw Error(ErrorCode::kLimit, fmt::format("the scene shows {} or more instances of meshes", total), {},
                "rig the meshes one by one, or with fewer instances");
  };
  for (const Index n : graph.order) {
    const std::optional<Index> mesh = nodes[n].mesh;
    if (!mesh) continue;
    if (nodes[n].skin) {
      count(1);
      result.push_back({n, *mesh, 0, bindPose.skinToWorld[*nodes[n].skin]});
      continue;
    }
    const GpuInstancing instancing = gpuInstancing(asset, n);
    count(std::max<std::uint64_t>(1, instancing.count));
    const std::vector<Affine> copies = gpuInstances(asset, instancing);
    if (copies.empty()) result.push_back({n, *mesh, 0, bindPose.nodeWorld[n]});
    for (Index c = 0; c < copies.size(); ++c) result.push_back({n, *mesh, c, bindPose.nodeWorld[n] * copies[c]});
  }
  return result;
}

class Collector {
 public:
  explicit Collector(const Asset& asset) : asset_(asset), meshes_(asset.document.meshes) {}

  Geometry collect() {
    const std::vector<MeshInstance> instances = meshInstances(asset_);
    checkSize(instances);
    geometry_.positions.reserve(vertexCount_);
    for (const MeshInstance& instance : instances) {
      const std::vector<gltf::Primitive>& primitives = meshes_[instance.mesh].primitives;
      for (Index p = 0; p < primitives.size(); ++p) addPrimitive(instance, p, primitives[p]);
    }
    if (geometry_.triangles.empty()) {
      throw KnownError(ErrorKind::kNoSurface,
                       {ErrorCode::kBadData, "has no triangle", {}, "limber needs a surface, not points or lines"});
    }
    return std::move(geometry_);
  }

 private:
  void checkSize(const std::vector<MeshInstance>& instances) {
    std::uint64_t stored = 0;
    std::set<Index> met;
    for (const MeshInstance& instance : instances) {
      for (const gltf::Primitive& primitive : meshes_[instance.mesh].primitives) {
        const std::optional<Index> accessor = primitive.attributes.find("POSITION");
        if (!accessor) continue;
        const Index count = accessorInfo(asset_, *accessor).count;
        vertexCount_ += count;
        if (met.insert(*accessor).second) stored += count;
      }
    }
    if (vertexCount_ > kMaxVertices || vertexCount_ > read_bounds::kShownVertices.of(stored)) {
      throw Error(ErrorCode::kLimit, fmt::format("the scene shows {} vertices", vertexCount_), {},
                  "rig the meshes one by one, or with fewer instances");
    }
  }

  void addPrimitive(const MeshInstance& instance, Index index, const gltf::Primitive& primitive) {
    const std::optional<Index> accessor = primitive.attributes.find("POSITION");
    if (!accessor) return;
    const std::vector<float> stored = readFloats(asset_, *accessor);
    const auto first = static_cast<Index>(geometry_.positions.size());
    const auto count = static_cast<Index>(stored.size() / 3);
    for (Index v = 0; v < count; ++v) {
      const Vec3 position = instance.toWorld * Eigen::Map<const Vec3f>(&stored[3 * std::size_t{v}]).cast<double>();
      geometry_.positions.push_back(position.cast<float>());
      if (geometry_.positions.back().allFinite()) continue;
      throw Error(ErrorCode::kBadData, fmt::format("vertex {} has a position that is not a finite number", v),
                  fmt::format("meshes[{}].primitives[{}]", instance.mesh, index));
    }

    const bool mirrored = instance.toWorld.linear().determinant() < 0;
    for (Triangle t : primitiveTriangles(asset_, primitive, count)) {
      if (mirrored) std::swap(t[1], t[2]);
      geometry_.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    geometry_.instances.push_back({instance.node, instance.mesh, index, instance.copy, first, count, instance.toWorld});
    const Vec3 halfStep = Vec3::Constant(0.5 * gridStep(stored, accessorInfo(asset_, *accessor)));
    geometry_.instances.back().quantisation = (instance.toWorld.linear() * halfStep.asDiagonal()).norm();
  }

  const Asset& asset_;
  const std::vector<gltf::Mesh>& meshes_;
  Geometry geometry_;
  std::uint64_t vertexCount_ = 0;
};

}  // namespace

Geometry collectGeometry(const Asset& asset) {
  try {
    return Collector(asset).collect();
  } catch (const Error& error) {
    throwWithin(error, asset.name);
  }
}

std::vector<StoredVertices> storedVertices(const Geometry& geometry) {
  std::vector<StoredVertices> stored;
  for (const PrimitiveInstance& instance : geometry.instances) {
    stored.push_back(
        {instance.firstVertex, instance.vertexCount, instance.toWorld.translation(), instance.quantisation});
  }
  return stored;
}

PreparedMesh prepareGeometry(const Geometry& geometry, std::span<const Triangle> triangles) {
  return prepareMesh(geometry.positions, triangles, storedVertices(geometry));
}

}  // namespace limber
