#include "limber/document/fbx/import_fbx_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limber/document/embedded_texture.h"
#include "limber/document/fbx/records/fbx_values.h"
#include "limber/document/side_file.h"
#include "limber/document/uri.h"
#include "limber/document/utf8.h"

namespace limber {

namespace {

constexpr double kSdkGrey = 0.8;  // DiffuseColor where a file says nothing

// Properties that textures are read of: the SDK's own, and those of shaders, as their plug-ins name them.
constexpr std::array<std::string_view, 7> kColorMaps = {"DiffuseColor",
                                                        "base_color",
                                                        "baseColor",
                                                        "Maya|baseColor",
                                                        "3dsMax|Parameters|base_color_map",
                                                        "Maya|TEX_color_map",
                                                        "3dsMax|main|base_color_map"};
constexpr std::array<std::string_view, 3> kNormalMaps = {"NormalMap", "Maya|TEX_normal_map", "3dsMax|main|norm_map"};
constexpr std::array<std::string_view, 1> kEmissionMaps = {"EmissiveColor"};

double clamped(double value) {
  return std::clamp(value, 0.0, 1.0);
}

Vec3 clamped(const Vec3& color) {
  return color.cwiseMax(0).cwiseMin(1);
}

// Phong's exponent as the roughness of a highlight of about the same width (Walter and others 2007).
double roughnessOfExponent(double exponent) {
  return std::sqrt(2 / (2 + std::max(exponent, 0.0)));
}

// A file that is embedded: bytes, or in text files their base64.
std::optional<Bytes> contentOf(const FbxNode& video) {
  const FbxNode* content = video.find("Content");
  if (!content || content->values.empty()) return std::nullopt;
  if (const auto* bytes = std::get_if<Bytes>(&content->values[0])) {
    return bytes->empty() ? std::nullopt : std::optional<Bytes>(*bytes);
  }
  // The SDK cuts it into parts that are padded each.
  Bytes result;
  std::string text;
  bool isEmpty = true;
  try {
    for (std::size_t i = 0; i < content->values.size(); ++i) {
      text += fbxText(*content, i).value_or("");
      if (text.empty() || (text.size() % 4 != 0 && i + 1 < content->values.size())) continue;
      const Bytes part = decodeDataUri("data:;base64," + text).bytes;
      result.insert(result.end(), part.begin(), part.end());
      text.clear();
      isEmpty = false;
    }
  } catch (const Error&) {
    return Bytes();  // reported as no picture that is known
  }
  return isEmpty ? std::nullopt : std::optional<Bytes>(std::move(result));
}

}  // namespace

FbxMaterials::FbxMaterials(Asset& asset, const FbxObjects& objects, const Resolver& resolver)
    : asset_(asset), objects_(objects), resolver_(resolver), areAllBlack_(allBlack()) {}

// Exporters that know no colours write black for all of it, which would show nothing of the shape.
bool FbxMaterials::allBlack() const {
  bool anyMaterial = false;
  for (Index o = 0; o < objects_.count(); ++o) {
    if (!objects_.is(o, "Material")) continue;
    anyMaterial = true;
    const bool hasTexture = std::any_of(objects_.sources(o).begin(), objects_.sources(o).end(),
                                        [](const FbxObjects::Link& link) { return !link.property.empty(); });
    const bool hasColor = !colorOf(o, "DiffuseColor", "DiffuseFactor", kSdkGrey).isZero(0) ||
                          !colorOf(o, "EmissiveColor", "EmissiveFactor", 0).isZero(0);
    if (hasTexture || hasColor) return false;
  }
  return anyMaterial;
}

Index FbxMaterials::material(Index object, const std::vector<std::string>& textureSets) {
  const auto [known, isNew] = materials_.try_emplace({object, textureSets});
  if (isNew) known->second = addElement(asset_.document.materials, convert(object, textureSets));
  return known->second;
}

Index FbxMaterials::defaultMaterial() {
  if (!default_) {
    gltf::Material material;
    gltf::MetallicRoughness& surface = material.pbrMetallicRoughness.emplace();
    surface.baseColorFactor = Vec4(kSdkGrey, kSdkGrey, kSdkGrey, 1);
    surface.metallicFactor = 0;
    default_ = addElement(asset_.document.materials, std::move(material));
  }
  return *default_;
}

Vec3 FbxMaterials::colorOf(Index object, std::string_view color, std::string_view factor, double otherwise) const {
  const FbxProperties properties = objects_.properties(object);
  return clamped(properties.vector(color, Vec3::Constant(otherwise)) * properties.number(factor, 1));
}

// Blender writes the alpha into TransparencyFactor, Maya always 1; both have the SDK's older "Opacity" beside it.
// Without that it is what the SDK makes of the transparent colour.
double FbxMaterials::opacityOf(const FbxProperties& properties) const {
  double opacity = 1;
  if (const std::optional<Vec3> color = properties.vector("TransparentColor")) {
    opacity = 1 - properties.number("TransparencyFactor", 0) * color->mean();
  }
  opacity = clamped(properties.number("Opacity", opacity));
  return opacity == 0 ? 1 : opacity;  // exporters that mean "not set"; a wholly invisible surface helps nobody
}

gltf::Material FbxMaterials::convert(Index object, const std::vector<std::string>& textureSets) {
  const FbxProperties properties = objects_.properties(object);
  gltf::Material result;
  result.name = objects_[object].name;
  gltf::MetallicRoughness& surface = result.pbrMetallicRoughness.emplace();
  surface.baseColorTexture = textureUse(object, kColorMaps, textureSets);
  // A texture replaces the colour, but its factor still dims the texture.
  Vec3 base = surface.baseColorTexture ? clamped(Vec3(Vec3::Ones() * properties.number("DiffuseFactor", 1)))
                                       : colorOf(object, "DiffuseColor", "DiffuseFactor", kSdkGrey);
  if (areAllBlack_) {
    base = Vec3::Constant(kSdkGrey);
    asset_.warnings.add("black-materials", "materials that are all black are made grey", result.name);
  }
  const double opacity = opacityOf(properties);
  surface.baseColorFactor = Vec4(base.x(), base.y(), base.z(), opacity);
  if (opacity < 1) result.alphaMode = "BLEND";
  surface.metallicFactor = 0;
  const double exponent = properties.number("ShininessExponent", properties.number("Shininess", 0));
  surface.roughnessFactor = clamped(roughnessOfExponent(exponent));

  result.normalTexture = textureUse(object, kNormalMaps, textureSets);
  result.emissiveTexture = textureUse(object, kEmissionMaps, textureSets);
  result.emissiveFactor = result.emissiveTexture ? clamped(Vec3(Vec3::Ones() * properties.number("EmissiveFactor", 1)))
                                                 : colorOf(object, "EmissiveColor", "EmissiveFactor", 0);
  warnOfOthers(object);
  return result;
}

void FbxMaterials::warnOfOthers(Index object) {
  const auto isIn = [](std::span<const std::string_view> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const auto& [source, property] : objects_.sources(object)) {
    const bool isTexture = objects_.is(source, "Texture") || objects_.is(source, "LayeredTexture");
    const bool isRead = isIn(kColorMaps, property) || isIn(kNormalMaps, property) || isIn(kEmissionMaps, property);
    if (!isTexture || property.empty() || isRead || !others_.insert(property).second) continue;
    asset_.warnings.add("other-textures", "textures of what is neither colour nor normals nor emission are left out",
                        objects_[object].name + "." + validUtf8(property));
  }
}

std::optional<Index> FbxMaterials::textureOf(Index object, std::string_view property) {
  for (const FbxObjects::Link& link : objects_.sources(object)) {
    if (link.property != property) continue;
    if (objects_.is(link.object, "Texture")) return link.object;
    if (!objects_.is(link.object, "LayeredTexture")) continue;
    const std::vector<Index> layers = objects_.sources(link.object, "Texture");
    if (layers.size() > 1) {
      asset_.warnings.add("layered-textures", "of layered textures only the first is kept", objects_[object].name);
    }
    if (!layers.empty()) return layers[0];
  }
  return std::nullopt;
}

std::optional<gltf::TextureUse> FbxMaterials::textureUse(Index object, std::span<const std::string_view> properties,
                                                         const std::vector<std::string>& textureSets) {
  for (const std::string_view property : properties) {
    const std::optional<Index> source = textureOf(object, property);
    const std::optional<Index> index = source ? texture(*source) : std::nullopt;
    if (!index) continue;
    gltf::TextureUse use;
    use.index = *index;
    const std::string_view set = objects_.properties(*source).text("UVSet");
    const auto named = std::find(textureSets.begin(), textureSets.end(), set);
    if (named != textureSets.end()) use.texCoord = static_cast<Index>(named - textureSets.begin());
    return use;
  }
  return std::nullopt;
}

std::optional<Index> FbxMaterials::texture(Index object) {
  const auto [known, isNew] = textures_.try_emplace(object);
  if (!isNew) return known->second;
  const std::optional<Index> picture = image(object);
  if (!picture) return std::nullopt;
  gltf::Texture made;
  made.source = *picture;
  known->second = addElement(asset_.document.textures, std::move(made));
  const FbxProperties properties = objects_.properties(object);
  if (!properties.vector("Translation", Vec3::Zero()).isZero(0) ||
      properties.vector("Scaling", Vec3::Ones()) != Vec3::Ones() ||
      !properties.vector("Rotation", Vec3::Zero()).isZero(0)) {
    asset_.warnings.add("texture-transforms", "textures that are moved, turned or scaled lie as if they were not",
                        objects_[object].name);
  }
  gltf::Sampler sampler;
  if (properties.integer("WrapModeU", 0) == 1) sampler.wrapS = gltf::kClampToEdge;
  if (properties.integer("WrapModeV", 0) == 1) sampler.wrapT = gltf::kClampToEdge;
  if (sampler.wrapS != gltf::kRepeat || sampler.wrapT != gltf::kRepeat) {
    asset_.document.textures[*known->second].sampler = addElement(asset_.document.samplers, sampler);
  }
  return known->second;
}

// What is embedded, else the file beside the model.
std::optional<Index> FbxMaterials::image(Index texture) {
  std::vector<const FbxNode*> nodes = {objects_[texture].node};
  for (const Index video : objects_.sources(texture, "Video")) {
    const FbxNode& node = *objects_[video].node;
    nodes.push_back(&node);
    if (const auto known = imageOfVideo_.find(video); known != imageOfVideo_.end()) return known->second;
    if (const std::optional<Bytes> content = contentOf(node)) {
      const std::string_view path = fbxChildText(node, "RelativeFilename");
      return imageOfVideo_[video] = addEmbeddedImage(asset_, path.empty() ? objects_[video].name : path, content);
    }
  }
  std::string missing;
  for (const FbxNode* node : nodes) {
    for (const char* child : {"RelativeFilename", "FileName", "Filename"}) {
      const std::string name(fbxChildText(*node, child));
      if (name.empty()) continue;
      if (const auto known = imageOfFile_.find(name); known != imageOfFile_.end()) return known->second;
      if (const std::optional<Bytes> bytes = sideFile(resolver_, name)) {
        return imageOfFile_[name] = addEmbeddedImage(asset_, name, bytes);
      }
      if (missing.empty()) missing = name;
    }
  }
  return addEmbeddedImage(asset_, missing, std::nullopt);
}

}  // namespace limber
