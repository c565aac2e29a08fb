#include "limber/samples/model_builder.h"

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"

namespace limber {

namespace {

// glTF wants linear colour factors. Within 0.3 % of the sRGB curve, and the same on every machine.
double linearFactor(int srgb) {
  const double x = srgb / 255.0;
  const double linear = x * (x * (x * 0.305306011 + 0.682171111) + 0.012522878);
  return double(int(linear * 10000 + 0.5)) / 10000;
}

ByteSpan bytesOf(std::span<const float> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

Index addIndices(Asset& asset, const std::vector<Index>& indices, Index vertexCount) {
  const Index count = static_cast<Index>(indices.size());
  if (vertexCount > 65535) {
    return addAccessor(asset, {count, 1, ComponentType::kU32, false},
                       {reinterpret_cast<const std::uint8_t*>(indices.data()), indices.size() * sizeof(Index)},
                       kIndexTarget);
  }
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  return addAccessor(asset, {count, 1, ComponentType::kU16, false},
                     {reinterpret_cast<const std::uint8_t*>(narrow.data()), narrow.size() * 2}, kIndexTarget);
}

// The triangles of one material with vertices of their own.
Json addPrimitive(Asset& asset, const SymmetricMesh& mesh, int material) {
  std::vector<Index> newNumber(mesh.positions.size(), kNoIndex), indices;
  std::vector<float> positions, normals;
  Index count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.materials[t] != material) continue;
    for (const Index v : mesh.triangles[t]) {
      if (newNumber[v] == kNoIndex) {
        newNumber[v] = count++;
        positions.insert(positions.end(), mesh.positions[v].data(), mesh.positions[v].data() + 3);
        normals.insert(normals.end(), mesh.normals[v].data(), mesh.normals[v].data() + 3);
      }
      indices.push_back(newNumber[v]);
    }
  }
  Json primitive;
  primitive["attributes"]["POSITION"] = addFloatAccessor(asset, positions, 3, kVertexTarget, true);
  primitive["attributes"]["NORMAL"] =
      addAccessor(asset, {count, 3, ComponentType::kF32, false}, bytesOf(normals), kVertexTarget);
  primitive["indices"] = addIndices(asset, indices, count);
  return primitive;
}

}  // namespace

ModelBuilder::ModelBuilder(std::string_view name) {
  Json& json = asset_.json();
  json = Json::object();
  json["asset"] = {{"version", "2.0"}, {"generator", "limber sample"}};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"name", std::string(name)}, {"nodes", Json::array()}}});
  for (const char* key : {"nodes", "meshes", "materials"}) json[key] = Json::array();
  asset_.name = name;
  asset_.format = "glb";
}

Index ModelBuilder::addMaterial(const SampleMaterial& material) {
  Json& materials = asset_.json()["materials"];
  Json color = Json::array();
  for (const int channel : material.srgb) color.push_back(linearFactor(channel));
  color.push_back(1.0);
  materials.push_back(
      {{"name", std::string(material.name)},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", color}, {"metallicFactor", material.metallic}, {"roughnessFactor", material.roughness}}}});
  return static_cast<Index>(materials.size() - 1);
}

Index ModelBuilder::addMesh(std::string_view name, const SymmetricMesh& mesh, std::span<const Index> materials) {
  Json primitives = Json::array();
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const int number = static_cast<int>(m);
    if (std::find(mesh.materials.begin(), mesh.materials.end(), number) == mesh.materials.end()) continue;
    Json primitive = addPrimitive(asset_, mesh, number);
    primitive["material"] = materials[m];
    primitives.push_back(std::move(primitive));
  }
  Json& meshes = asset_.json()["meshes"];
  meshes.push_back({{"name", std::string(name)}, {"primitives", std::move(primitives)}});
  return static_cast<Index>(meshes.size() - 1);
}

Index ModelBuilder::addNode(std::string_view name, std::optional<Index> mesh, const Transform& placed,
                            std::optional<Index> parent) {
  Json& json = asset_.json();
  Json node = {{"name", std::string(name)}};
  if (mesh) node["mesh"] = *mesh;
  if (placed.translation != Vec3::Zero()) {
    node["translation"] = {placed.translation.x(), placed.translation.y(), placed.translation.z()};
  }
  if (placed.rotation.coeffs() != Quat::Identity().coeffs()) {
    node["rotation"] = {placed.rotation.x(), placed.rotation.y(), placed.rotation.z(), placed.rotation.w()};
  }
  if (placed.scale != Vec3::Ones()) node["scale"] = {placed.scale.x(), placed.scale.y(), placed.scale.z()};
  json["nodes"].push_back(std::move(node));
  const Index index = static_cast<Index>(json["nodes"].size() - 1);
  Json& siblings = parent ? json["nodes"][*parent]["children"] : json["scenes"][0]["nodes"];
  siblings.push_back(index);
  return index;
}

Asset ModelBuilder::take() {
  return std::move(asset_);
}

Asset modelOf(const Character& character) {
  ModelBuilder builder(character.name);
  std::vector<Index> materials;
  for (const SampleMaterial& material : character.materials) materials.push_back(builder.addMaterial(material));
  const Index mesh = builder.addMesh(character.name, buildCharacter(character), materials);
  builder.addNode(character.name, mesh);
  return builder.take();
}

}  // namespace limber
