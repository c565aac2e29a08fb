#include "limber/samples/model_builder.h"

#include <algorithm>
#include <string>
#include <vector>

#include "limber/document/gltf/accessor.h"

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
gltf::Primitive addPrimitive(Asset& asset, const SymmetricMesh& mesh, int material) {
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
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.attributes.set("NORMAL",
                           addAccessor(asset, {count, 3, ComponentType::kF32, false}, bytesOf(normals), kVertexTarget));
  primitive.indices = addIndices(asset, indices, count);
  return primitive;
}

}  // namespace

ModelBuilder::ModelBuilder(std::string_view name) {
  asset_.document.about.generator = "limber sample";
  asset_.document.scenes.emplace_back().name = name;
  asset_.document.scene = 0;
  asset_.name = name;
  asset_.format = "glb";
}

Index ModelBuilder::addMaterial(const SampleMaterial& material) {
  gltf::Material added;
  added.name = material.name;
  gltf::MetallicRoughness& surface = added.pbrMetallicRoughness.emplace();
  const auto& [red, green, blue] = material.srgb;
  surface.baseColorFactor = Vec4(linearFactor(red), linearFactor(green), linearFactor(blue), 1);
  surface.metallicFactor = material.metallic;
  surface.roughnessFactor = material.roughness;
  return addElement(asset_.document.materials, std::move(added));
}

Index ModelBuilder::addMesh(std::string_view name, const SymmetricMesh& mesh, std::span<const Index> materials) {
  gltf::Mesh added;
  added.name = name;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const int number = static_cast<int>(m);
    if (std::find(mesh.materials.begin(), mesh.materials.end(), number) == mesh.materials.end()) continue;
    added.primitives.push_back(addPrimitive(asset_, mesh, number));
    added.primitives.back().material = materials[m];
  }
  return addElement(asset_.document.meshes, std::move(added));
}

Index ModelBuilder::addNode(std::string_view name, std::optional<Index> mesh, const Transform& placed,
                            std::optional<Index> parent) {
  gltf::Document& document = asset_.document;
  gltf::Node node;
  node.name = name;
  node.mesh = mesh;
  if (placed.translation != Vec3::Zero()) node.translation = placed.translation;
  if (placed.rotation.coeffs() != Quat::Identity().coeffs()) node.rotation = placed.rotation.coeffs();
  if (placed.scale != Vec3::Ones()) node.scale = placed.scale;
  const Index index = addElement(document.nodes, std::move(node));
  std::vector<Index>& siblings = parent ? document.nodes[*parent].children : document.scenes[0].nodes;
  siblings.push_back(index);
  return index;
}

Asset ModelBuilder::take() {
  return std::move(asset_);
}

Asset modelOf(const ModelRecipe& character) {
  ModelBuilder builder(character.name);
  std::vector<Index> materials;
  for (const SampleMaterial& material : character.materials) materials.push_back(builder.addMaterial(material));
  const Index mesh = builder.addMesh(character.name, buildCharacter(character), materials);
  builder.addNode(character.name, mesh);
  return builder.take();
}

}  // namespace limber
