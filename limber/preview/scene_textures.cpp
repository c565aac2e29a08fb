#include "limber/preview/scene_textures.h"

#include <cmath>
#include <map>
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

class TextureCollector {
 public:
  TextureCollector(const Asset& asset, Scene& scene) : asset_(asset), root_(asset), scene_(scene) {}

  // Gives the instance's vertices their coordinates. Its texture, kNoIndex for none.
  Index add(const PrimitiveInstance& instance, std::size_t vertexCount) {
    const JsonView primitive = root_.array("meshes")[instance.mesh].array("primitives")[instance.primitive];
    const JsonView materials = root_.array("materials");
    const std::optional<Index> material = primitive.index("material", materials.size());
    if (!material) return kNoIndex;
    const JsonView info = materials[*material].object("pbrMetallicRoughness").object("baseColorTexture");
    const std::optional<Index> number = info.index("index", root_.array("textures").size());
    const JsonView transform = extensionOf(info, "KHR_texture_transform");
    const std::size_t set = transform.count("texCoord").value_or(info.count("texCoord").value_or(0));
    const std::string key = fmt::format("TEXCOORD_{}", set);
    const std::optional<Index> accessor = primitive.object("attributes").index(key, root_.array("accessors").size());
    if (!number || !accessor) return kNoIndex;
    const Index texture = textureAt(*number);
    if (texture == kNoIndex) return kNoIndex;
    const std::vector<float> values = readFloats(asset_, *accessor);
    if (values.size() != 2 * std::size_t{instance.vertexCount}) return kNoIndex;
    scene_.uvs.resize(vertexCount, Vec2f::Zero());
    const UvTransform toTexture(transform);
    for (std::size_t v = 0; v < instance.vertexCount; ++v) {
      scene_.uvs[instance.firstVertex + v] = toTexture(values[2 * v], values[2 * v + 1]);
    }
    return texture;
  }

 private:
  // The document's texture of that number as one of the scene's.
  Index textureAt(Index number) {
    const auto [known, isNew] = textures_.try_emplace(number, kNoIndex);
    if (!isNew) return known->second;
    const JsonView texture = root_.array("textures")[number], samplers = root_.array("samplers");
    const std::optional<Index> source = texture.index("source", root_.array("images").size());
    const std::optional<Bytes> file = source ? imageBytes(asset_, *source) : std::nullopt;
    std::optional<Image> image = file ? decodeImage(*file) : std::nullopt;
    if (!image) {
      scene_.warnings.add("undrawn-textures", "textures cannot be drawn; their surfaces have a plain colour",
                          texture.path());
      return kNoIndex;
    }
    const std::optional<Index> sampler = texture.index("sampler", samplers.size());
    const auto wrap = [&](std::string_view key) {
      return sampler ? wrapOf(samplers[*sampler], key) : TextureWrap::kRepeat;
    };
    scene_.textures.push_back(std::make_shared<const Texture>(std::move(*image), wrap("wrapS"), wrap("wrapT")));
    return known->second = static_cast<Index>(scene_.textures.size() - 1);
  }

  const Asset& asset_;
  JsonView root_;
  Scene& scene_;
  std::map<Index, Index> textures_;
};

}  // namespace

std::vector<bool> addTextures(const Asset& asset, const Geometry& geometry, Scene& scene) {
  TextureCollector collector(asset, scene);
  std::vector<Index> ofVertex(geometry.positions.size(), kNoIndex);
  std::vector<bool> textured;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const Index texture = collector.add(instance, geometry.positions.size());
    std::fill_n(ofVertex.begin() + instance.firstVertex, instance.vertexCount, texture);
    textured.push_back(texture != kNoIndex);
  }
  if (scene.textures.empty()) return textured;
  scene.textureOf.reserve(scene.triangles.size());
  for (const Triangle& triangle : scene.triangles) scene.textureOf.push_back(ofVertex[triangle[0]]);
  return textured;
}

}  // namespace limber
