#include "limber/document/usd/usd_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/text/numbers.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"

namespace limber {

namespace {

constexpr const char* kTransformName = "KHR_texture_transform";
constexpr const char* kUnlit = "KHR_materials_unlit";
constexpr const char* kEmissiveStrength = "KHR_materials_emissive_strength";
constexpr const char* kIor = "KHR_materials_ior";
constexpr const char* kClearcoat = "KHR_materials_clearcoat";
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr std::array kKnown = {kUnlit, kEmissiveStrength, kIor, kClearcoat, kSpecularGlossiness};

// An array of as many numbers as `byDefault` has, or that.
template <typename Vector>
Vector numbersIn(const JsonView& object, const char* key, Vector byDefault) {
  const JsonView list = object.array(key);
  if (static_cast<Eigen::Index>(list.size()) != byDefault.size()) return byDefault;
  for (std::size_t i = 0; i < list.size(); ++i) byDefault[static_cast<Eigen::Index>(i)] = list[i].asNumber();
  return byDefault;
}

// glTF's v points down, and its angle turns with the axes as they are drawn (KHR_texture_transform; so do Khronos'
// viewer, three.js and Blender). v = 1 - V on both sides gives the same turn and another translation.
UsdUvTransform uvTransform(const JsonView& extension) {
  const Eigen::Vector2d offset = numbersIn(extension, "offset", Eigen::Vector2d(0, 0));
  const Eigen::Vector2d scale = numbersIn(extension, "scale", Eigen::Vector2d(1, 1));
  const double angle = extension.number("rotation", 0);
  UsdUvTransform transform;
  transform.scale = scale.cast<float>();
  transform.degrees = static_cast<float>(angle / kDegree);
  transform.translation = Vec2f(static_cast<float>(offset.x() + scale.y() * std::sin(angle)),
                                static_cast<float>(1 - offset.y() - scale.y() * std::cos(angle)));
  return transform;
}

class SurfaceReader {
 public:
  SurfaceReader(const gltf::Document& document, Index number)
      : document_(document), material_(document.materials[number]), location_(fmt::format("materials[{}]", number)) {}

  UsdSurface read() {
    surface_.hasOpacity = material_.alphaMode == "BLEND" || material_.alphaMode == "MASK";
    if (extensionOf(material_, kUnlit) != nullptr) {
      addUnlit();
    } else if (const JsonView gloss = extension(kSpecularGlossiness); gloss.exists()) {
      addSpecularGlossiness(gloss);
      addRelief();
    } else {
      addMetallicRoughness();
      addRelief();
    }
    if (material_.extensions.exists()) {
      for (const auto& [name, content] : material_.extensions->items()) {
        if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) surface_.unsaid.push_back(name);
      }
    }
    for (const UsdInput& input : surface_.inputs) {
      if (input.texture) surface_.uvSets.insert(input.texture->uvSet);
    }
    return std::move(surface_);
  }

 private:
  JsonView extension(const char* name) const { return {extensionOf(material_, name), location_}; }

  UsdTexture textureAt(Index texture, Index uvSet, const Json* transform) const {
    UsdTexture read;
    read.texture = texture;
    read.uvSet = uvSet;
    if (transform == nullptr) return read;
    const JsonView view(transform, location_);
    read.uvSet = static_cast<Index>(std::min<std::size_t>(view.count("texCoord").value_or(uvSet), kNoIndex));
    read.transform = uvTransform(view);
    return read;
  }
  std::optional<UsdTexture> texture(const std::optional<gltf::TextureUse>& use) const {
    if (!use) return std::nullopt;
    return textureAt(use->index, use->texCoord, extensionOf(*use, kTransformName));
  }
  std::optional<UsdTexture> texture(const JsonView& owner, const char* key) const {
    const JsonView use = owner.object(key);
    if (!use.exists()) return std::nullopt;
    const JsonView transform = use.object("extensions").object(kTransformName);
    return textureAt(use.requireIndex("index", document_.textures.size()),
                     static_cast<Index>(std::min<std::size_t>(use.count("texCoord").value_or(0), kNoIndex)),
                     transform.exists() ? &transform.json() : nullptr);
  }

  void add(const char* type, const char* name, UsdValue value, std::optional<UsdTexture> texture = {},
           const char* channel = "", const Vec4f& scale = Vec4f::Ones(), const Vec4f& bias = Vec4f::Zero()) {
    if (texture) {
      texture->scale = scale;
      texture->bias = bias;
      texture->isColor = std::string_view(type) == "color3f" || std::string_view(name) == "opacity";
    }
    surface_.inputs.push_back({type, name, std::move(value), std::move(texture), channel});
  }
  void addNumber(const char* name, double factor, std::optional<UsdTexture> texture = {}, const char* channel = "") {
    const auto value = static_cast<float>(factor);
    add("float", name, value, std::move(texture), channel, Vec4f(value, value, value, 1));
  }

  // The base colour goes to `name`, its alpha to the opacity.
  void addColor(const char* name, const Vec4& factor, const std::optional<UsdTexture>& texture) {
    surface_.colorInput = name;
    surface_.baseColor = factor.cast<float>();
    surface_.isTextured = texture.has_value();
    add("color3f", name, Vec3f(surface_.baseColor.head<3>()), texture, "rgb", surface_.baseColor);
    if (!surface_.hasOpacity) return;
    add("float", "opacity", surface_.baseColor.w(), texture, "a", surface_.baseColor);
    if (material_.alphaMode == "MASK") addNumber("opacityThreshold", material_.alphaCutoff);
  }

  void addUnlit() {
    const gltf::MetallicRoughness base = material_.pbrMetallicRoughness.value_or(gltf::MetallicRoughness());
    add("color3f", "diffuseColor", Vec3f(Vec3f::Zero()));
    addColor("emissiveColor", base.baseColorFactor.value_or(Vec4::Ones()), texture(base.baseColorTexture));
    addNumber("roughness", 1);
  }

  void addMetallicRoughness() {
    const gltf::MetallicRoughness base = material_.pbrMetallicRoughness.value_or(gltf::MetallicRoughness());
    addColor("diffuseColor", base.baseColorFactor.value_or(Vec4::Ones()), texture(base.baseColorTexture));
    const std::optional<UsdTexture> both = texture(base.metallicRoughnessTexture);
    addNumber("metallic", base.metallicFactor, both, "b");
    addNumber("roughness", base.roughnessFactor, both, "g");
  }

  void addSpecularGlossiness(const JsonView& gloss) {
    addColor("diffuseColor", numbersIn(gloss, "diffuseFactor", Vec4(1, 1, 1, 1)), texture(gloss, "diffuseTexture"));
    const Vec3 specular = numbersIn(gloss, "specularFactor", Vec3(1, 1, 1));
    const auto glossiness = static_cast<float>(gloss.number("glossinessFactor", 1));
    const std::optional<UsdTexture> both = texture(gloss, "specularGlossinessTexture");
    Vec4f scale = Vec4f::Ones();
    scale.head<3>() = specular.cast<float>();
    add("int", "useSpecularWorkflow", 1);
    add("color3f", "specularColor", Vec3f(specular.cast<float>()), both, "rgb", scale);
    // Roughness is what glossiness lacks of one.
    add("float", "roughness", 1 - glossiness, both, "a", Vec4f(1, 1, 1, -glossiness), Vec4f(0, 0, 0, 1));
  }

  // What all but unlit materials have.
  void addRelief() {
    if (material_.normalTexture) {
      const float depth = strengthOf(*material_.normalTexture, "scale");
      add("normal3f", "normal", {}, texture(material_.normalTexture), "rgb", Vec4f(2 * depth, 2 * depth, 2, 1),
          Vec4f(-depth, -depth, -1, 0));
    }
    if (material_.occlusionTexture) {
      const float strength = strengthOf(*material_.occlusionTexture, "strength");
      const float rest = 1 - strength;
      add("float", "occlusion", {}, texture(material_.occlusionTexture), "r", Vec4f(strength, strength, strength, 1),
          Vec4f(rest, rest, rest, 0));
    }
    if (const Vec3& glow = material_.emissiveFactor; !glow.isZero(0)) {
      const double strength = extension(kEmissiveStrength).number("emissiveStrength", 1);
      Vec4f scale = Vec4f::Ones();
      scale.head<3>() = (strength * glow).cast<float>();
      add("color3f", "emissiveColor", Vec3f(scale.head<3>()), texture(material_.emissiveTexture), "rgb", scale);
    }
    if (const JsonView ior = extension(kIor); ior.exists()) addNumber("ior", ior.number("ior", 1.5));
    if (const JsonView coat = extension(kClearcoat); coat.exists()) {
      addNumber("clearcoat", coat.number("clearcoatFactor", 0), texture(coat, "clearcoatTexture"), "r");
      addNumber("clearcoatRoughness", coat.number("clearcoatRoughnessFactor", 0),
                texture(coat, "clearcoatRoughnessTexture"), "g");
    }
  }

  // A normal texture's "scale", an occlusion's "strength".
  float strengthOf(const gltf::TextureUse& use, const char* key) const {
    if (!use.asRead.exists()) return 1;
    return static_cast<float>(JsonView(&*use.asRead, location_).number(key, 1));
  }

  const gltf::Document& document_;
  const gltf::Material& material_;
  std::string location_;
  UsdSurface surface_;
};

}  // namespace

UsdSurface usdSurface(const gltf::Document& document, Index material) {
  return SurfaceReader(document, material).read();
}

}  // namespace limber
