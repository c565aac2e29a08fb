#include "limber/document/mesh/rest_mesh.h"

#include <algorithm>

#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/shape_surface.h"

namespace limber {

namespace {

// Meshes that have some.
std::size_t meshesWithShapes(const gltf::Document& document) {
  return static_cast<std::size_t>(std::count_if(document.meshes.begin(), document.meshes.end(), [](const auto& mesh) {
    return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [](const auto& primitive) { return !primitive.targets.empty(); });
  }));
}

}  // namespace

ExportMesh exportRestMesh(const Asset& asset, Warnings& warnings) {
  const std::optional<Asset> joined = withJoinedBinds(asset);
  const Asset& whole = joined ? *joined : asset;
  ExportMesh mesh = exportMesh(whole, shapedGeometry(whole));
  if (hasRig(asset)) {
    warnings.add("lost-rig",
                 "joints and weights are left out, and the mesh is in its rest pose (limber pose --bake writes it in "
                 "another)");
  }
  if (const std::size_t clips = asset.document.animations.size(); clips > 0) {
    warnings.add("lost-clips", "clips are left out", asset.document.animations.front().name, clips);
  }
  if (const std::size_t meshes = meshesWithShapes(asset.document); meshes > 0) {
    warnings.add("lost-shapes", "meshes lose their blend shapes, and are as the file's weights shape them", {}, meshes);
  }
  return mesh;
}

}  // namespace limber
