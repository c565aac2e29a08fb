#include "limber/parts/part_materials.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor_sweep.h"
#include "limber/asset/node_edit.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/unique_names.h"
#include "limber/parts/part_triangles.h"

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
    const std::vector<Json> painted = paintedPrimitives();
    for (Index m = 0; m < painted.size(); ++m) {
      if (!painted[m].empty()) asset_.json()["meshes"][m]["primitives"] = painted[m];
    }
  }

 private:
  Json& primitiveOf(std::size_t instance) {
    const PrimitiveInstance& at = geometry_.instances[instance];
    return asset_.json()["meshes"][meshOf_.at(at.node)]["primitives"][at.primitive];
  }

  // Nodes that show a mesh together get one each.
  void ownMeshes() {
    std::set<Index> taken;
    std::size_t copies = 0;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      copies += instance.copy > 0;
      if (meshOf_.count(instance.node) > 0) continue;
      Json& json = asset_.json();
      Index mesh = instance.mesh;
      if (!taken.insert(mesh).second) {
        mesh = static_cast<Index>(json["meshes"].size());
        const Json copy = json["meshes"][instance.mesh];
        json["meshes"].push_back(copy);
        json["nodes"][instance.node]["mesh"] = mesh;
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
      const Index material = indexMember(primitiveOf(i), "material").value_or(kNoIndex);
      for (const PartTriangles& run : triangles_[i]) {
        if (needed.try_emplace({run.part, material}, 0).second) ++countOf[run.part];
      }
    }
    UniqueNames names;
    for (const Json& material : elements(asset_, "materials")) names.add(nameOf(material));
    Json& materials = asset_.json()["materials"];
    if (!materials.is_array()) materials = Json::array();
    for (auto& [key, number] : needed) {
      const auto [part, original] = key;
      Json material = original == kNoIndex ? Json::object() : Json(materials[original]);
      const std::string own = nameOf(material), &name = parts_.names[part];
      material["name"] = names.add(countOf[part] > 1 && !own.empty() ? fmt::format("{}_{}", name, own) : name);
      tint(part, material);
      number = static_cast<Index>(materials.size());
      materials.push_back(std::move(material));
    }
    materialOf_ = std::move(needed);
  }

  void tint(Index part, Json& material) const {
    if (tints_.empty()) return;
    Json& surface = material["pbrMetallicRoughness"];
    if (!surface.is_object()) surface = {{"metallicFactor", 0.0}};
    Json& factor = surface["baseColorFactor"];
    if (!factor.is_array()) factor = {1.0, 1.0, 1.0, 1.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto share = static_cast<double>(tints_[part][static_cast<Eigen::Index>(i)]);
      factor[i] = shortDouble(factor[i].get<double>() * share);
    }
  }

  // #meshes, null for those that stay.
  std::vector<Json> paintedPrimitives() {
    std::vector<Json> painted(elementCount(asset_, "meshes"));
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const PrimitiveInstance& instance = geometry_.instances[i];
      if (instance.copy > 0) continue;
      const Json original = primitiveOf(i);
      Json& primitives = painted[meshOf_.at(instance.node)];
      if (triangles_[i].empty()) primitives.push_back(original);
      for (const PartTriangles& run : triangles_[i]) {
        Json primitive = original;
        primitive.erase("mode");
        primitive["indices"] = addTriangleAccessor(asset_, run.triangles, instance.vertexCount);
        primitive["material"] = materialOf_.at({run.part, indexMember(original, "material").value_or(kNoIndex)});
        primitives.push_back(std::move(primitive));
      }
    }
    keepHidden(painted);
    return painted;
  }

  // Primitives without positions are in no geometry.
  void keepHidden(std::vector<Json>& painted) {
    std::set<std::pair<Index, Index>> met;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      met.emplace(meshOf_.at(instance.node), instance.primitive);
    }
    for (Index m = 0; m < painted.size(); ++m) {
      if (painted[m].empty()) continue;
      const Json& primitives = asset_.json()["meshes"][m]["primitives"];
      for (Index p = 0; p < primitives.size(); ++p) {
        if (met.count({m, p}) == 0) painted[m].push_back(primitives[p]);
      }
    }
  }

  Asset& asset_;
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
