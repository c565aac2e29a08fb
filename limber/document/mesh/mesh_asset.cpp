#include "limber/document/mesh/mesh_asset.h"

#include "limber/document/gltf/accessor.h"

namespace limber {

Asset meshAsset(const TriMesh& mesh, const std::string& name) {
  Asset asset;
  std::vector<float> positions;
  std::vector<Index> corners;
  for (const Vec3f& p : mesh.positions) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.indices = addAccessor(
      asset, {static_cast<Index>(corners.size()), 1, ComponentType::kU32, false},
      {reinterpret_cast<const std::uint8_t*>(corners.data()), corners.size() * sizeof(Index)}, kIndexTarget);
  gltf::Mesh model;
  model.name = name;
  model.primitives.push_back(std::move(primitive));
  gltf::Node node;
  node.name = name;
  node.mesh = addElement(asset.document.meshes, std::move(model));
  gltf::Scene scene;
  scene.nodes = {addElement(asset.document.nodes, std::move(node))};
  asset.document.scene = addElement(asset.document.scenes, std::move(scene));
  asset.document.about.generator = "limber";
  asset.name = name + ".glb";
  asset.format = "glb";
  return asset;
}

}  // namespace limber
