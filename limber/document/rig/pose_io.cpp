#include "limber/document/rig/pose_io.h"

#include <fmt/format.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/skinned_nodes.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"

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

std::span<const float> floatsOf(std::span<const Vec3f> vectors, const PrimitiveInstance& instance) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  return {vectors[instance.firstVertex].data(), std::size_t{3} * instance.vertexCount};
}

// Under a mirroring transform the triangles turn round, so that outside stays outside.
void turnTriangles(Asset& asset, gltf::Primitive& primitive, const Geometry& geometry,
                   const PrimitiveInstance& instance) {
  std::vector<Index> indices;
  for (const Triangle& triangle : geometry.triangles) {
    if (triangle[0] < instance.firstVertex || triangle[0] >= instance.firstVertex + instance.vertexCount) continue;
    for (const Index v : triangle) indices.push_back(v - instance.firstVertex);
  }
  if (indices.empty()) return;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(indices.data());
  const AccessorInfo info{static_cast<Index>(indices.size()), 1, ComponentType::kU32, false};
  primitive.indices = addAccessor(asset, info, {bytes, sizeof(Index) * indices.size()}, kIndexTarget);
  primitive.mode = gltf::kTriangles;
}

void freezePrimitive(Asset& asset, gltf::Primitive& primitive, const Geometry& geometry,
                     const PrimitiveInstance& instance, std::span<const Vec3f> positions,
                     std::span<const Vec3f> normals) {
  gltf::Attributes& attributes = primitive.attributes;
  attributes.set("POSITION", addFloatAccessor(asset, floatsOf(positions, instance), 3, kVertexTarget, true));
  if (attributes.find("NORMAL")) {
    attributes.set("NORMAL", addFloatAccessor(asset, floatsOf(normals, instance), 3, kVertexTarget));
  }
  asset.warnings.add("tangents", "parts lose their tangents, which readers make anew", {},
                     attributes.erase("TANGENT") ? 1 : 0);
  asset.warnings.add("morph-targets", "parts lose their morph targets, which no longer fit", {},
                     primitive.targets.empty() ? 0 : 1);
  reportLostInfluences(primitive, asset.document.meshes[instance.mesh].name, asset.warnings);
  primitive.targets.clear();
  eraseWeightAttributes(primitive);
  if (instance.toWorld.linear().determinant() < 0) turnTriangles(asset, primitive, geometry, instance);
}

bool canMorph(const gltf::Document& document, Index node) {
  const std::optional<Index> mesh = document.nodes[node].mesh;
  if (!mesh) return false;
  const std::vector<gltf::Primitive>& primitives = document.meshes[*mesh].primitives;
  return !primitives.empty() && !primitives[0].targets.empty();
}

}  // namespace

Mat3 cofactorsOf(const Mat3& linear) {
  Mat3 cofactors;
  for (int i = 0; i < 3; ++i) cofactors.col(i) = linear.col((i + 1) % 3).cross(linear.col((i + 2) % 3));
  return cofactors;
}

Vec3f turnNormal(const Mat3& linear, const Vec3f& normal) {
  const Vec3 turned = cofactorsOf(linear) * normal.cast<double>();
  const double length = turned.norm();
  return length > 0 ? Vec3f((turned / length).cast<float>()) : Vec3f(Vec3f::Zero());
}

Pose readNodePose(const Asset& asset, const AssetSkeleton& skeleton) {
  const SceneGraph graph = readSceneGraph(asset.document);
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
  const SceneGraph graph = readSceneGraph(asset.document);
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
    setNodeTransform(asset.document.nodes[skeleton.jointNode[j]], locals[j].toAffine(), false);
  }
}

std::vector<Vec3f> readNormals(const Asset& asset, const Geometry& geometry) {
  std::vector<Vec3f> normals(geometry.positions.size(), Vec3f::Zero());
  for (const PrimitiveInstance& instance : geometry.instances) {
    const gltf::Primitive& primitive = asset.document.meshes[instance.mesh].primitives[instance.primitive];
    const std::optional<Index> accessor = primitive.attributes.find("NORMAL");
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
    const Index number = nodes.meshFor(group);
    gltf::Mesh& mesh = asset.document.meshes[number];
    for (Index i = group.firstInstance; i < group.endInstance; ++i) {
      const PrimitiveInstance& instance = geometry.instances[i];
      freezePrimitive(asset, mesh.primitives[instance.primitive], geometry, instance, positions, normals);
    }
    mesh.weights.clear();
    nodes.attachStatic(group, number);
  }
  nodes.finish();
  removeChannels(
      asset, [&](Index node, std::string_view path) { return path == "weights" && !canMorph(asset.document, node); });
  removeRig(asset);
}

}  // namespace limber
