#include "limber/preview/scene_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/images.h"
#include "limber/preview/image/image_decode.h"

namespace limber {

namespace {

TextureWrap wrapOf(Index wrap) {
  if (wrap == gltf::kClampToEdge) return TextureWrap::kClamp;
  return wrap == gltf::kMirroredRepeat ? TextureWrap::kMirror : TextureWrap::kRepeat;
}

// KHR_texture_transform: first scaled, then turned, then moved.
struct UvTransform {
  double offset[2] = {0, 0}, scale[2] = {1, 1}, rotation = 0;

  explicit UvTransform(const JsonView& extension) : rotation(extension.number("rotation", 0)) {
    const JsonView offsets = extension.array("offset"), scales = extension.array("scale");
    for (std::size_t i = 0; i < 2; ++i) {
      if (offsets.size() == 2) offset[i] = offsets[i].asNumber();
      if (scales.size() == 2) scale[i] = scales[i].asNumber();
    }
  }
  Vec2f operator()(float u, float v) const {
    const double x = scale[0] * u, y = scale[1] * v, c = std::cos(rotation), s = std::sin(rotation);
    return {static_cast<float>(c * x + s * y + offset[0]), static_cast<float>(c * y - s * x + offset[1])};
  }
};

class MaterialCollector {
 public:
  MaterialCollector(const Asset& asset, Scene& scene) : asset_(asset), document_(asset.document), scene_(scene) {}

  // The instance's material as one of the scene's, and its vertices' coordinates; kNoIndex where a colour for each
  // vertex says all.
  Index add(const PrimitiveInstance& instance, std::size_t vertexCount) {
    const gltf::Primitive& primitive = document_.meshes[instance.mesh].primitives[instance.primitive];
    if (!primitive.material) return kNoIndex;
    const Index number = *primitive.material;
    const bool isTextured = addTexture(instance, primitive, number, vertexCount);
    const auto [known, isNew] = materials_.try_emplace({number, isTextured}, kNoIndex);
    if (isNew) known->second = addMaterial(document_.materials[number], isTextured);
    return known->second;
  }

 private:
  // Null where it has none.
  static const gltf::TextureUse* baseColorTexture(const gltf::Material& material) {
    const auto& surface = material.pbrMetallicRoughness;
    return surface && surface->baseColorTexture ? &*surface->baseColorTexture : nullptr;
  }

  // Gives the vertices their coordinates where the material has a texture that can be drawn on them.
  bool addTexture(const PrimitiveInstance& instance, const gltf::Primitive& primitive, Index material,
                  std::size_t vertexCount) {
    const gltf::TextureUse* use = baseColorTexture(document_.materials[material]);
    if (use == nullptr) return false;
    constexpr const char* kTransform = "KHR_texture_transform";
    const std::string location =
        fmt::format("materials[{}].pbrMetallicRoughness.baseColorTexture.extensions.{}", material, kTransform);
    const JsonView transform(extensionOf(*use, kTransform), location);
    const std::size_t set = transform.count("texCoord").value_or(use->texCoord);
    const std::optional<Index> accessor = primitive.attributes.find(fmt::format("TEXCOORD_{}", set));
    if (!accessor || !textureOf(use->index)) return false;
    const std::vector<float> values = readFloats(asset_, *accessor);
    if (values.size() != 2 * std::size_t{instance.vertexCount}) return false;
    scene_.uvs.resize(vertexCount, Vec2f::Zero());
    const UvTransform toTexture(transform);
    for (std::size_t v = 0; v < instance.vertexCount; ++v) {
      scene_.uvs[instance.firstVertex + v] = toTexture(values[2 * v], values[2 * v + 1]);
    }
    return true;
  }

  Index addMaterial(const gltf::Material& material, bool isTextured) {
    SceneMaterial added;
    if (isTextured) added.texture = textureOf(baseColorTexture(material)->index);
    added.isOpaque = material.alphaMode != "MASK" && material.alphaMode != "BLEND";
    if (!added.isOpaque) {
      const auto& surface = material.pbrMetallicRoughness;
      if (surface && surface->baseColorFactor) added.opacity = std::clamp((*surface->baseColorFactor)[3], 0.0, 1.0);
      if (material.alphaMode == "MASK") added.cutoff = material.alphaCutoff;
    }
    if (added.isOpaque && !added.texture) return kNoIndex;
    scene_.materials.push_back(std::move(added));
    return static_cast<Index>(scene_.materials.size() - 1);
  }

  // None where it cannot be drawn.
  std::shared_ptr<const Texture> textureOf(Index number) {
    const auto [known, isNew] = textures_.try_emplace(number);
    if (isNew) known->second = readTexture(number);
    return known->second;
  }

  std::shared_ptr<const Texture> readTexture(Index number) {
    const gltf::Texture& texture = document_.textures[number];
    const std::optional<Bytes> file = texture.source ? imageBytes(asset_, *texture.source) : std::nullopt;
    std::optional<DecodedImage> image = file ? decodeImage(*file) : std::nullopt;
    if (!image) {
      scene_.warnings.add("undrawn-textures", "textures cannot be drawn; their surfaces have a plain colour",
                          fmt::format("textures[{}]", number));
      return nullptr;
    }
    const gltf::Sampler sampler = texture.sampler ? document_.samplers[*texture.sampler] : gltf::Sampler();
    return std::make_shared<const Texture>(std::move(image->colors), wrapOf(sampler.wrapS), wrapOf(sampler.wrapT),
                                           std::move(image->alpha));
  }

  const Asset& asset_;
  const gltf::Document& document_;
  Scene& scene_;
  std::map<Index, std::shared_ptr<const Texture>> textures_;  // by their numbers in the document
  std::map<std::pair<Index, bool>, Index> materials_;         // by number and whether the texture is drawn
};

}  // namespace

std::vector<bool> addMaterials(const Asset& asset, const Geometry& geometry, Scene& scene) {
  MaterialCollector collector(asset, scene);
  std::vector<Index> ofVertex(geometry.positions.size(), kNoIndex);
  std::vector<bool> textured;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const Index material = collector.add(instance, geometry.positions.size());
    std::fill_n(ofVertex.begin() + instance.firstVertex, instance.vertexCount, material);
    textured.push_back(material != kNoIndex && scene.materials[material].texture);
  }
  if (scene.materials.empty()) return textured;
  scene.materialOf.reserve(scene.triangles.size());
  for (const Triangle& triangle : scene.triangles) scene.materialOf.push_back(ofVertex[triangle[0]]);
  return textured;
}

}  // namespace limber
