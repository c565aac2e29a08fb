#include "limber/session/scene/scene_io.h"

#include <algorithm>

#include "limber/document/merge_assets.h"
#include "limber/document/write.h"
#include "limber/session/scene/scene_layout.h"
#include "limber/session/scene/session_io.h"

namespace limber {

namespace {

std::size_t partOf(std::span<const SceneMember> members, const Session* session) {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const SceneMember& m) { return m.session.get() == session; });
  return static_cast<std::size_t>(found - members.begin());
}

Bytes sceneGlb(std::span<const SceneMember> members) {
  std::vector<AssetPart> parts;
  for (const SceneMember& member : members) {
    AssetPart part{posedDocument(member.session->state()), member.name, member.placement.toAffine(), std::nullopt};
    if (member.attachment) {
      const SessionState& carrier = member.attachment->to->state();
      part.transform = member.attachment->offset;
      part.carrier = {partOf(members, member.attachment->to.get()),
                      carrier.rig->binding().jointNode[requireJoint(carrier, member.attachment->joint)]};
    }
    parts.push_back(std::move(part));
  }
  return writeGlb(mergeAssets(std::move(parts)));
}

// The members' materials and meshes in the order of sceneMesh(), without regard to where they stand.
Asset sceneMaterials(std::span<const SceneMember> members) {
  std::vector<AssetPart> parts;
  for (const SceneMember& member : members) {
    parts.push_back({member.session->state().rig->asset().clone(), member.name, Affine::Identity(), std::nullopt});
  }
  return mergeAssets(std::move(parts));
}

// Puts a mesh behind what is there.
void append(ExportMesh& all, ExportMesh mesh) {
  const auto vertices = static_cast<Index>(all.positions.size()), textures = static_cast<Index>(all.textures.size()),
             materials = static_cast<Index>(all.materials.size());
  const std::size_t triangles = all.triangles.size();
  if (!mesh.uvs.empty() || !all.uvs.empty()) {
    all.uvs.resize(all.positions.size(), Vec2f::Zero());
    mesh.uvs.resize(mesh.positions.size(), Vec2f::Zero());
  }
  all.positions.insert(all.positions.end(), mesh.positions.begin(), mesh.positions.end());
  all.normals.insert(all.normals.end(), mesh.normals.begin(), mesh.normals.end());
  all.uvs.insert(all.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
  for (const Triangle& t : mesh.triangles) all.triangles.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
  for (ExportPart& part : mesh.parts) {
    part.firstTriangle += triangles;
    if (part.material) *part.material += materials;
    all.parts.push_back(std::move(part));
  }
  for (ExportMaterial& material : mesh.materials) {
    if (material.texture) *material.texture += textures;
    all.materials.push_back(std::move(material));
  }
  for (ExportTexture& texture : mesh.textures) all.textures.push_back(std::move(texture));
}

ExportMesh sceneMesh(std::span<const SceneMember> members) {
  ExportMesh all;
  for (std::size_t m = 0; m < members.size(); ++m) {
    ExportMesh mesh = posedMesh(members[m].session->state());
    const Affine transform = toScene(members, m);
    const Mat3 turn = decompose(transform).rotation.toRotationMatrix();
    for (Vec3f& position : mesh.positions) position = (transform * position.cast<double>()).cast<float>();
    for (Vec3f& normal : mesh.normals) normal = (turn * normal.cast<double>()).cast<float>();
    append(all, std::move(mesh));
  }
  return all;
}

}  // namespace

Bytes exportScene(std::span<const SceneMember> members, ExportFormat format) {
  if (format == ExportFormat::kGlb) return sceneGlb(members);
  return encodeMesh(sceneMesh(members), format == ExportFormat::kUsdz ? sceneMaterials(members) : Asset(), format);
}

}  // namespace limber
