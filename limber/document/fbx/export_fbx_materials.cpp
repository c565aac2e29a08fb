#include "limber/document/fbx/export_fbx_materials.h"

#include <cmath>

#include <fmt/format.h>

#include "limber/document/images.h"

namespace limber {

namespace {

void tellOfMissing(const std::string& where, Warnings& warnings) {
  warnings.add("unsupported-images", "textures that are neither PNG nor JPEG are left out", where);
}

}  // namespace

FbxId FbxMaterialWriter::material(std::optional<Index> number) {
  if (const auto known = materials_.find(number); known != materials_.end()) return known->second;
  static const gltf::Material kDefault;
  const gltf::Material& material = number ? asset_.document.materials[*number] : kDefault;
  const gltf::MetallicRoughness surface = material.pbrMetallicRoughness.value_or(gltf::MetallicRoughness());
  const Vec4 color = surface.baseColorFactor.value_or(Vec4::Ones());
  const double alpha = material.alphaMode == "BLEND" ? color.w() : 1;
  const bool isTextured = surface.metallicRoughnessTexture.has_value();  // its factors alone say little
  const double metallic = isTextured ? 0 : surface.metallicFactor,
               roughness = isTextured ? 0.5 : surface.roughnessFactor;

  std::string name = material.name;
  if (name.empty()) name = number ? fmt::format("material_{}", *number) : "default";
  FbxObjectWriter::Made made = objects_.make("Material", name, "Material", "");
  const FbxId id = materials_[number] = made.id;
  addRecord(made.record, "Version", {std::int32_t{102}});
  addRecord(made.record, "ShadingModel", {std::string("Phong")});
  addRecord(made.record, "MultiLayer", {std::int32_t{0}});
  FbxPropertyWriter properties(made.record);
  properties.color("DiffuseColor", color.head<3>());
  properties.number("DiffuseFactor", 1);
  properties.color("EmissiveColor", material.emissiveFactor);
  properties.number("EmissiveFactor", 1);
  properties.color("AmbientColor", Vec3::Zero());
  properties.color("SpecularColor", Vec3::Ones());
  properties.number("SpecularFactor", 0.25);
  properties.number("Shininess", std::pow(10 * (1 - roughness), 2));
  properties.number("ShininessExponent", std::pow(10 * (1 - roughness), 2));
  properties.number("ReflectionFactor", metallic);
  properties.color("TransparentColor", Vec3::Constant(1 - alpha));
  properties.number("TransparencyFactor", 1 - alpha);
  properties.number("Opacity", alpha);
  writeTextures(material, id);
  return id;
}

void FbxMaterialWriter::writeTextures(const gltf::Material& material, FbxId id) {
  const gltf::MetallicRoughness surface = material.pbrMetallicRoughness.value_or(gltf::MetallicRoughness());
  if (surface.baseColorTexture) {
    connect(*surface.baseColorTexture, id, "DiffuseColor");
    if (!surface.baseColorFactor.value_or(Vec4::Ones()).head<3>().isOnes(1e-3)) {
      warnings_.add("colored-textures", "a colour that a picture is multiplied by is lost in most programs",
                    material.name);
    }
    if (material.alphaMode != "OPAQUE") {
      warnings_.add("transparent-textures", "that a picture's alpha cuts out or lets through is not said",
                    material.name);
    }
  }
  if (material.normalTexture) connect(*material.normalTexture, id, "NormalMap");
  if (material.emissiveTexture) connect(*material.emissiveTexture, id, "EmissiveColor");
  if (surface.metallicRoughnessTexture || material.occlusionTexture) {
    warnings_.add("lost-textures", "pictures of metalness, roughness and occlusion are left out", material.name);
  }
}

void FbxMaterialWriter::connect(const gltf::TextureUse& use, FbxId material, std::string_view property) {
  const gltf::Texture& source = asset_.document.textures[use.index];
  if (!source.source) {  // in a format that an extension of the texture knows
    tellOfMissing(fmt::format("textures[{}]", use.index), warnings_);
    return;
  }
  const std::optional<FbxId> picture = video(*source.source);
  if (!picture) return;
  if (use.extensions.exists()) {
    warnings_.add("texture-transforms", "places of textures are written without what extensions say of them",
                  source.name);
  }
  const gltf::Sampler sampler = source.sampler ? asset_.document.samplers[*source.sampler] : gltf::Sampler();
  const std::string& file = files_[*source.source];
  FbxObjectWriter::Made made = objects_.make("Texture", file, "Texture", "");
  addRecord(made.record, "Type", {std::string("TextureVideoClip")});
  addRecord(made.record, "Version", {std::int32_t{202}});
  addRecord(made.record, "TextureName", {fbxName(file, "Texture")});
  addRecord(made.record, "Media", {fbxName(file, "Video")});
  addRecord(made.record, "FileName", {file});
  addRecord(made.record, "RelativeFilename", {file});
  FbxPropertyWriter properties(made.record);
  properties.text("UVSet", use.texCoord == 0 ? "UVMap" : fmt::format("UVMap_{}", use.texCoord));
  properties.flag("UseMaterial", true);
  properties.choice("WrapModeU", sampler.wrapS == gltf::kClampToEdge);
  properties.choice("WrapModeV", sampler.wrapT == gltf::kClampToEdge);
  const FbxId id = made.id;
  objects_.connect(id, material, property);
  objects_.connect(*picture, id);
}

std::optional<FbxId> FbxMaterialWriter::video(Index image) {
  const auto [known, isNew] = videos_.try_emplace(image);
  if (!isNew) return known->second;
  std::optional<Bytes> bytes = imageBytes(asset_, image);
  const std::string_view extension = bytes ? imageFormat(*bytes).extension : std::string_view();
  if (extension != ".png" && extension != ".jpg") {
    tellOfMissing(fmt::format("images[{}]", image), warnings_);
    return std::nullopt;
  }
  const std::string& file = files_[image] = fileOf(image, extension);
  FbxObjectWriter::Made made = objects_.make("Video", file, "Video", "Clip");
  known->second = made.id;
  addRecord(made.record, "Type", {std::string("Clip")});
  FbxPropertyWriter(made.record).add("Path", "KString", "XRefUrl", "", {file});
  addRecord(made.record, "UseMipMap", {std::int32_t{0}});
  addRecord(made.record, "Filename", {file});
  addRecord(made.record, "RelativeFilename", {file});
  addRecord(made.record, "Content", {std::move(*bytes)});
  return known->second;
}

// A name to unpack the picture under, whatever the document calls it: names of folders and of other systems' devices
// stay out. Different for each image.
std::string FbxMaterialWriter::fileOf(Index image, std::string_view extension) const {
  std::string stem;
  for (const char c : asset_.document.images[image].name) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    stem += isPlain ? c : '_';
  }
  return fmt::format("{}_{}{}", stem.empty() ? "image" : stem, image, extension);
}

}  // namespace limber
