#include "limber/actions/parts/part_materials.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/actions/parts/part_triangles.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

using PartMaterial = std::pair<Index, Index>;  // part, and the material that was there or kNoIndex

class PartPainter {
 public:
  PartPainter(Asset& asset, const Geometry& geometry, const SurfaceParts& parts, std::span<const Vec3f> tints)
      : asset_(asset), geometry_(geometry), parts_(parts), tints_(tints), triangles_(partTriangles(geometry, parts)) {}

  void run() {
    ownMeshes();
    makeMaterials();
    std::vector<Primitives> painted = paintedPrimitives();
    for (Index m = 0; m < painted.size(); ++m) {
      if (!painted[m].empty()) document_.meshes[m].primitives = std::move(painted[m]);
    }
  }

 private:
  using Primitives = std::vector<gltf::Primitive>;

  const gltf::Primitive& primitiveOf(std::size_t instance) const {
    const PrimitiveInstance& at = geometry_.instances[instance];
    return document_.meshes[meshOf_.at(at.node)].primitives[at.primitive];
  }

  // Nodes that show a mesh together get one each.
  void ownMeshes() {
    std::set<Index> taken;
    std::size_t copies = 0;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      copies += instance.copy > 0;
      if (meshOf_.count(instance.node) > 0) continue;
      Index mesh = instance.mesh;
      if (!taken.insert(mesh).second) {
        mesh = addElement(document_.meshes, document_.meshes[mesh]);
        document_.nodes[instance.node].mesh = mesh;
      }
      meshOf_[instance.node] = mesh;
    }
    if (copies > 0) {
      asset_.warnings.add("instanced-parts", "instances have the parts of the first of them", {}, copies);
    }
  }

  void makeMaterials() {
    std::map<PartMaterial, Index> needed;  // -> material
    std::map<Index, Index> countOf;        // part -> how many
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (geometry_.instances[i].copy > 0) continue;
      const Index material = primitiveOf(i).material.value_or(kNoIndex);
      for (const PartTriangles& run : triangles_[i]) {
        if (needed.try_emplace({run.part, material}, 0).second) ++countOf[run.part];
      }
    }
    UniqueNames names;
    for (const gltf::Material& material : document_.materials) names.add(material.name);
    for (auto& [key, number] : needed) {
      const auto [part, original] = key;
      gltf::Material material = original == kNoIndex ? gltf::Material() : document_.materials[original];
      const std::string &own = material.name, &name = parts_.names[part];
      material.name = names.add(countOf[part] > 1 && !own.empty() ? fmt::format("{}_{}", name, own) : name);
      tint(part, material);
      number = addElement(document_.materials, std::move(material));
    }
    materialOf_ = std::move(needed);
  }

  void tint(Index part, gltf::Material& material) const {
    if (tints_.empty()) return;
    if (!material.pbrMetallicRoughness) material.pbrMetallicRoughness.emplace().metallicFactor = 0;
    std::optional<Vec4>& color = material.pbrMetallicRoughness->baseColorFactor;
    if (!color) color = Vec4::Ones();
    for (Eigen::Index i = 0; i < 3; ++i) (*color)[i] = shortDouble((*color)[i] * static_cast<double>(tints_[part][i]));
  }

  // #meshes, empty for those that stay.
  std::vector<Primitives> paintedPrimitives() {
    std::vector<Primitives> painted(document_.meshes.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const PrimitiveInstance& instance = geometry_.instances[i];
      if (instance.copy > 0) continue;
      const gltf::Primitive& original = primitiveOf(i);
      Primitives& primitives = painted[meshOf_.at(instance.node)];
      if (triangles_[i].empty()) primitives.push_back(original);
      for (const PartTriangles& run : triangles_[i]) {
        gltf::Primitive& primitive = primitives.emplace_back(original);
        primitive.mode = gltf::kTriangles;
        primitive.indices = addTriangleAccessor(asset_, run.triangles, instance.vertexCount);
        primitive.material = materialOf_.at({run.part, original.material.value_or(kNoIndex)});
      }
    }
    keepHidden(painted);
    return painted;
  }

  // Primitives without positions are in no geometry.
  void keepHidden(std::vector<Primitives>& painted) const {
    std::set<std::pair<Index, Index>> met;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      met.emplace(meshOf_.at(instance.node), instance.primitive);
    }
    for (Index m = 0; m < painted.size(); ++m) {
      if (painted[m].empty()) continue;
      const Primitives& primitives = document_.meshes[m].primitives;
      for (Index p = 0; p < primitives.size(); ++p) {
        if (met.count({m, p}) == 0) painted[m].push_back(primitives[p]);
      }
    }
  }

  Asset& asset_;
  gltf::Document& document_ = asset_.document;
  const Geometry& geometry_;
  const SurfaceParts& parts_;
  std::span<const Vec3f> tints_;
  std::vector<std::vector<PartTriangles>> triangles_;
  std::map<Index, Index> meshOf_;  // node -> the mesh that is its alone
  std::map<PartMaterial, Index> materialOf_;
};

}  // namespace

void paintParts(Asset& asset, const Geometry& geometry, const SurfaceParts& parts, std::span<const Vec3f> tints) {
  const AccessorSweep sweep(asset);
  PartPainter(asset, geometry, parts, tints).run();
  sweep.sweep(asset);
}

}  // namespace limber
