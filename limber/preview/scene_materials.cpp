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

#include "limber/asset/accessor.h"
#include "limber/asset/extensions.h"
#include "limber/asset/images.h"
#include "limber/preview/image_decode.h"

namespace limber {

namespace {

TextureWrap wrapOf(const JsonView& sampler, std::string_view key) {
  constexpr double kClampToEdge = 33071, kMirroredRepeat = 33648;  // glTF's numbers
  const double wrap = sampler.number(key, 0);
  if (wrap == kClampToEdge) return TextureWrap::kClamp;
  return wrap == kMirroredRepeat ? TextureWrap::kMirror : TextureWrap::kRepeat;
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
  MaterialCollector(const Asset& asset, Scene& scene) : asset_(asset), root_(asset), scene_(scene) {}

  // The instance's material as one of the scene's, and its vertices' coordinates; kNoIndex where a colour for each
  // vertex says all.
  Index add(const PrimitiveInstance& instance, std::size_t vertexCount) {
    const JsonView primitive = root_.array("meshes")[instance.mesh].array("primitives")[instance.primitive];
    const std::optional<Index> number = primitive.index("material", root_.array("materials").size());
    if (!number) return kNoIndex;
    const JsonView material = root_.array("materials")[*number];
    const bool isTextured = addTexture(instance, primitive, material, vertexCount);
    const auto [known, isNew] = materials_.try_emplace({*number, isTextured}, kNoIndex);
    if (isNew) known->second = addMaterial(material, isTextured);
    return known->second;
  }

 private:
  static JsonView baseColorTexture(const JsonView& material) {
    return material.object("pbrMetallicRoughness").object("baseColorTexture");
  }

  // Gives the vertices their coordinates where the material has a texture that can be drawn on them.
  bool addTexture(const PrimitiveInstance& instance, const JsonView& primitive, const JsonView& material,
                  std::size_t vertexCount) {
    const JsonView info = baseColorTexture(material);
    const JsonView transform = extensionOf(info, "KHR_texture_transform");
    const std::size_t set = transform.count("texCoord").value_or(info.count("texCoord").value_or(0));
    const std::string key = fmt::format("TEXCOORD_{}", set);
    const std::optional<Index> accessor = primitive.object("attributes").index(key, root_.array("accessors").size());
    if (!accessor || !textureOf(info)) return false;
    const std::vector<float> values = readFloats(asset_, *accessor);
    if (values.size() != 2 * std::size_t{instance.vertexCount}) return false;
    scene_.uvs.resize(vertexCount, Vec2f::Zero());
    const UvTransform toTexture(transform);
    for (std::size_t v = 0; v < instance.vertexCount; ++v) {
      scene_.uvs[instance.firstVertex + v] = toTexture(values[2 * v], values[2 * v + 1]);
    }
    return true;
  }

  Index addMaterial(const JsonView& material, bool isTextured) {
    SceneMaterial added;
    if (isTextured) added.texture = textureOf(baseColorTexture(material));
    const std::string_view mode = material.text("alphaMode", "OPAQUE");
    added.isOpaque = mode != "MASK" && mode != "BLEND";
    if (!added.isOpaque) {
      const JsonView factor = material.object("pbrMetallicRoughness").array("baseColorFactor");
      if (factor.size() == 4) added.opacity = std::clamp(factor[3].asNumber(), 0.0, 1.0);
      if (mode == "MASK") added.cutoff = material.number("alphaCutoff", 0.5);
    }
    if (added.isOpaque && !added.texture) return kNoIndex;
    scene_.materials.push_back(std::move(added));
    return static_cast<Index>(scene_.materials.size() - 1);
  }

  // None where it cannot be drawn.
  std::shared_ptr<const Texture> textureOf(const JsonView& info) {
    const std::optional<Index> number = info.index("index", root_.array("textures").size());
    if (!number) return nullptr;
    const auto [known, isNew] = textures_.try_emplace(*number);
    if (isNew) known->second = readTexture(root_.array("textures")[*number]);
    return known->second;
  }

  std::shared_ptr<const Texture> readTexture(const JsonView& texture) {
    const JsonView samplers = root_.array("samplers");
    const std::optional<Index> source = texture.index("source", root_.array("images").size());
    const std::optional<Bytes> file = source ? imageBytes(asset_, *source) : std::nullopt;
    std::optional<DecodedImage> image = file ? decodeImage(*file) : std::nullopt;
    if (!image) {
      scene_.warnings.add("undrawn-textures", "textures cannot be drawn; their surfaces have a plain colour",
                          texture.path());
      return nullptr;
    }
    const std::optional<Index> sampler = texture.index("sampler", samplers.size());
    const auto wrap = [&](std::string_view key) {
      return sampler ? wrapOf(samplers[*sampler], key) : TextureWrap::kRepeat;
    };
    return std::make_shared<const Texture>(std::move(image->colors), wrap("wrapS"), wrap("wrapT"),
                                           std::move(image->alpha));
  }

  const Asset& asset_;
  JsonView root_;
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
