#include "limber/asset/pose_io.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/node_edit.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/skinned_nodes.h"
#include "limber/asset/weight_attributes.h"

namespace limber {

namespace {

bool same(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs() && a.scale == b.scale;
}

// What a joint's local transform is relative to: nothing for a joint below a joint, else the nodes above the root.
Affine frameAbove(const SceneGraph& graph, const AssetSkeleton& skeleton, Index joint) {
  const Index node = skeleton.jointNode[joint];
  if (skeleton.skeleton.joints[joint].parent || !graph.parent[node]) return Affine::Identity();
  return graph.world[*graph.parent[node]];
}

// glTF's transform of a direction at right angles to the surface: the cofactors of the linear part.
Vec3f turnNormal(const Mat3& linear, const Vec3f& normal) {
  Mat3 cofactors;
  cofactors.col(0) = linear.col(1).cross(linear.col(2));
  cofactors.col(1) = linear.col(2).cross(linear.col(0));
  cofactors.col(2) = linear.col(0).cross(linear.col(1));
  const Vec3 turned = cofactors * normal.cast<double>();
  const double length = turned.norm();
  return length > 0 ? Vec3f((turned / length).cast<float>()) : Vec3f(Vec3f::Zero());
}

std::span<const float> floatsOf(std::span<const Vec3f> vectors, const PrimitiveInstance& instance) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  return {vectors[instance.firstVertex].data(), std::size_t{3} * instance.vertexCount};
}

// Under a mirroring transform the triangles turn round, so that outside stays outside.
void turnTriangles(Asset& asset, Json& primitive, const Geometry& geometry, const PrimitiveInstance& instance) {
  std::vector<Index> indices;
  for (const Triangle& triangle : geometry.triangles) {
    if (triangle[0] < instance.firstVertex || triangle[0] >= instance.firstVertex + instance.vertexCount) continue;
    for (const Index v : triangle) indices.push_back(v - instance.firstVertex);
  }
  if (indices.empty()) return;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(indices.data());
  const AccessorInfo info{static_cast<Index>(indices.size()), 1, ComponentType::kU32, false};
  primitive["indices"] = addAccessor(asset, info, {bytes, sizeof(Index) * indices.size()}, kIndexTarget);
  primitive.erase("mode");
}

void freezePrimitive(Asset& asset, Json& primitive, const Geometry& geometry, const PrimitiveInstance& instance,
                     std::span<const Vec3f> positions, std::span<const Vec3f> normals) {
  Json& attributes = primitive["attributes"];
  attributes["POSITION"] = addFloatAccessor(asset, floatsOf(positions, instance), 3, kVertexTarget, true);
  if (attributes.contains("NORMAL")) {
    attributes["NORMAL"] = addFloatAccessor(asset, floatsOf(normals, instance), 3, kVertexTarget);
  }
  asset.warnings.add("tangents", "parts lose their tangents, which readers make anew", {}, attributes.erase("TANGENT"));
  asset.warnings.add("morph-targets", "parts lose their morph targets, which no longer fit", {},
                     primitive.erase("targets"));
  eraseWeightAttributes(primitive);
  if (instance.toWorld.linear().determinant() < 0) turnTriangles(asset, primitive, geometry, instance);
}

bool canMorph(const Asset& asset, Index node) {
  const std::optional<Index> mesh = indexMember(elements(asset, "nodes")[node], "mesh");
  return mesh && elements(asset, "meshes")[*mesh].at("primitives")[0].contains("targets");
}

}  // namespace

Pose readNodePose(const Asset& asset, const AssetSkeleton& skeleton) {
  const SceneGraph graph = readSceneGraph(asset);
  Pose pose;
  for (Index j = 0; j < skeleton.skeleton.jointCount(); ++j) {
    pose.locals.push_back(decompose(frameAbove(graph, skeleton, j) * graph.local[skeleton.jointNode[j]]));
  }
  return pose;
}

void writeNodePose(Asset& asset, const AssetSkeleton& skeleton, const Pose& pose) {
  if (pose.locals.size() != skeleton.jointNode.size()) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("{} transforms for {} joints", pose.locals.size(), skeleton.jointNode.size()));
  }
  const SceneGraph graph = readSceneGraph(asset);
  const Pose before = readNodePose(asset, skeleton);
  std::vector<Transform> locals(pose.locals);
  for (Index j = 0; j < locals.size(); ++j) {
    if (skeleton.skeleton.joints[j].parent || same(locals[j], before.locals[j])) continue;
    const Affine local = frameAbove(graph, skeleton, j).inverse(Eigen::Affine) * locals[j].toAffine();
    if (!local.matrix().allFinite()) {
      throw Error(ErrorCode::kBadData, "stands below a node with a scale of 0, so it cannot be posed",
                  fmt::format("joint '{}'", skeleton.skeleton.joints[j].name));
    }
    locals[j] = decompose(local);
  }
  for (Index j = 0; j < locals.size(); ++j) {
    if (same(pose.locals[j], before.locals[j])) continue;
    setNodeTransform(asset.json()["nodes"][skeleton.jointNode[j]], locals[j].toAffine(), false);
  }
}

std::vector<Vec3f> readNormals(const Asset& asset, const Geometry& geometry) {
  std::vector<Vec3f> normals(geometry.positions.size(), Vec3f::Zero());
  for (const PrimitiveInstance& instance : geometry.instances) {
    const Json& primitive = elements(asset, "meshes")[instance.mesh].at("primitives")[instance.primitive];
    const std::optional<Index> accessor = indexMember(primitive.at("attributes"), "NORMAL");
    if (!accessor) continue;
    const std::vector<float> values = readFloats(asset, *accessor);
    for (std::size_t v = 0; v < instance.vertexCount; ++v) {
      const Vec3f normal(values[3 * v], values[3 * v + 1], values[3 * v + 2]);
      normals[instance.firstVertex + v] = turnNormal(instance.toWorld.linear(), normal);
    }
  }
  return normals;
}

void freezeGeometry(Asset& asset, const Geometry& geometry, std::span<const Vec3f> positions,
                    std::span<const Vec3f> normals) {
  if (positions.size() != geometry.positions.size() || normals.size() != positions.size()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} positions and {} normals for {} vertices", positions.size(),
                                                     normals.size(), geometry.positions.size()));
  }
  SkinnedNodes nodes(asset, geometry);
  for (const MeshGroup& group : nodes.groups()) {
    const Index mesh = nodes.meshFor(group);
    for (Index i = group.firstInstance; i < group.endInstance; ++i) {
      Json primitive = asset.json()["meshes"][mesh]["primitives"][geometry.instances[i].primitive];
      freezePrimitive(asset, primitive, geometry, geometry.instances[i], positions, normals);
      asset.json()["meshes"][mesh]["primitives"][geometry.instances[i].primitive] = std::move(primitive);
    }
    asset.json()["meshes"][mesh].erase("weights");
    nodes.placeStatic(group, mesh);
  }
  nodes.finish();
  removeChannels(asset, [&](Index node, std::string_view path) { return path == "weights" && !canMorph(asset, node); });
  removeRig(asset);
}

}  // namespace limber
