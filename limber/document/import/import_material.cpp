#include "limber/document/import/import_material.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include "limber/core/file/read_bounds.h"
#include "limber/document/embedded_texture.h"
#include "limber/document/import/import_sandbox.h"
#include "limber/document/import/import_text.h"

namespace limber {

namespace {

double unit(double value, double otherwise) {
  return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise;
}

std::optional<aiColor3D> color(const aiMaterial& material, const char* key) {
  aiColor3D value;
  if (material.Get(key, 0, 0, value) != aiReturn_SUCCESS) return std::nullopt;
  return value;
}

std::optional<double> number(const aiMaterial& material, const char* key) {
  ai_real value = 0;
  if (material.Get(key, 0, 0, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
  return value;
}

// Blinn-Phong's exponent as the roughness of a highlight of about the same width (Walter and others 2007).
double roughnessOf(double exponent) {
  return std::sqrt(2 / (2 + std::max(exponent, 0.0)));
}

}  // namespace

Index MaterialImporter::material(unsigned index) {
  const auto known = materials_.find(index);
  if (known != materials_.end()) return known->second;
  return materials_[index] = addElement(asset_.document.materials, convert(*scene_.mMaterials[index]));
}

gltf::Material MaterialImporter::convert(const aiMaterial& material) {
  gltf::Material result;
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) result.name = textOf(name);

  gltf::MetallicRoughness& surface = result.pbrMetallicRoughness.emplace();
  surface.baseColorTexture = textureUse(material, aiTextureType_BASE_COLOR);
  if (!surface.baseColorTexture) surface.baseColorTexture = textureUse(material, aiTextureType_DIFFUSE);
  const aiColor3D base =
      color(material, "$clr.base").value_or(color(material, "$clr.diffuse").value_or(aiColor3D(1, 1, 1)));
  double opacity = unit(number(material, "$mat.opacity").value_or(1), 1);
  if (opacity == 0) opacity = 1;  // exporters that mean "not set"; a wholly invisible surface helps nobody
  surface.baseColorFactor = Vec4(unit(base.r, 1), unit(base.g, 1), unit(base.b, 1), opacity);
  surface.metallicFactor = unit(number(material, "$mat.metallicFactor").value_or(0), 0);
  const double roughness = roughnessOf(number(material, "$mat.shininess").value_or(0));
  surface.roughnessFactor = unit(number(material, "$mat.roughnessFactor").value_or(roughness), 1);

  result.normalTexture = textureUse(material, aiTextureType_NORMALS);
  result.emissiveTexture = textureUse(material, aiTextureType_EMISSIVE);
  const aiColor3D emissive = color(material, "$clr.emissive").value_or(aiColor3D(0, 0, 0));
  if (emissive.r > 0 || emissive.g > 0 || emissive.b > 0) {
    result.emissiveFactor = Vec3(unit(emissive.r, 0), unit(emissive.g, 0), unit(emissive.b, 0));
  }
  if (opacity < 1) result.alphaMode = "BLEND";
  int twoSided = 0;
  result.doubleSided = material.Get(AI_MATKEY_TWOSIDED, twoSided) == aiReturn_SUCCESS && twoSided != 0;
  return result;
}

std::optional<gltf::TextureUse> MaterialImporter::textureUse(const aiMaterial& material, int kind) {
  aiString path;
  unsigned uvSet = 0;
  const auto type = static_cast<aiTextureType>(kind);
  if (material.GetTexture(type, 0, &path, nullptr, &uvSet) != aiReturn_SUCCESS || path.length == 0) return std::nullopt;
  const std::optional<Index> index = texture(std::string(path.data, path.length));
  if (!index) return std::nullopt;
  gltf::TextureUse use;
  use.index = *index;
  if (uvSet < AI_MAX_NUMBER_OF_TEXTURECOORDS) use.texCoord = uvSet;
  return use;
}

std::optional<Index> MaterialImporter::texture(const std::string& path) {
  const auto [known, isNew] = textures_.try_emplace(path);
  if (!isNew) return known->second;
  return known->second = addEmbeddedTexture(asset_, path, imageBytes(path));
}

std::optional<Bytes> MaterialImporter::imageBytes(const std::string& path) {
  if (const aiTexture* embedded = scene_.GetEmbeddedTexture(path.c_str())) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
    if (embedded->mHeight == 0) return Bytes(data, data + embedded->mWidth);  // a whole image file
    return Bytes();                                                           // bare pixels: told as unsupported
  }
  std::optional<Bytes> picture = io_.sideFile(path);
  if (!picture) return picture;
  const std::string_view content(reinterpret_cast<const char*>(picture->data()), picture->size());
  const bool isNew = pictures_.insert(std::hash<std::string_view>()(content)).second;
  if (isNew) allowMemory(static_cast<std::size_t>(read_bounds::kAssimpPicture * picture->size()));
  return picture;
}

}  // namespace limber
