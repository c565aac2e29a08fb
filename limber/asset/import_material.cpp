#include "limber/asset/import_material.h"

#include <algorithm>
#include <cmath>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <nlohmann/json.hpp>

#include "limber/asset/images.h"
#include "limber/asset/import_text.h"

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

// Appends bytes to the document's buffer as a view without an accessor.
Index addImageView(Asset& asset, ByteSpan bytes) {
  Json& json = asset.json();
  if (asset.buffers.empty()) {
    asset.buffers.emplace_back();
    json["buffers"].push_back(Json::object());
  }
  Bytes& buffer = asset.buffers[0].bytes;
  buffer.resize((buffer.size() + 3) / 4 * 4);
  const std::size_t offset = buffer.size();
  buffer.insert(buffer.end(), bytes.begin(), bytes.end());
  json["buffers"][0]["byteLength"] = buffer.size();
  Json& views = json["bufferViews"];
  views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
  return static_cast<Index>(views.size() - 1);
}

}  // namespace

Index MaterialImporter::material(unsigned index) {
  const auto known = materials_.find(index);
  if (known != materials_.end()) return known->second;
  Json converted = convert(*scene_.mMaterials[index]);
  Json& materials = asset_.json()["materials"];
  materials.push_back(std::move(converted));
  return materials_[index] = static_cast<Index>(materials.size() - 1);
}

Json MaterialImporter::convert(const aiMaterial& material) {
  Json result = Json::object();
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS && name.length > 0) result["name"] = textOf(name);

  Json pbr = Json::object();
  std::optional<Json> texture = textureInfo(material, aiTextureType_BASE_COLOR);
  if (!texture) texture = textureInfo(material, aiTextureType_DIFFUSE);
  const aiColor3D base =
      color(material, "$clr.base").value_or(color(material, "$clr.diffuse").value_or(aiColor3D(1, 1, 1)));
  double opacity = unit(number(material, "$mat.opacity").value_or(1), 1);
  if (opacity == 0) opacity = 1;  // exporters that mean "not set"; a wholly invisible surface helps nobody
  pbr["baseColorFactor"] = {unit(base.r, 1), unit(base.g, 1), unit(base.b, 1), opacity};
  if (texture) pbr["baseColorTexture"] = *texture;
  pbr["metallicFactor"] = unit(number(material, "$mat.metallicFactor").value_or(0), 0);
  const double roughness = roughnessOf(number(material, "$mat.shininess").value_or(0));
  pbr["roughnessFactor"] = unit(number(material, "$mat.roughnessFactor").value_or(roughness), 1);
  result["pbrMetallicRoughness"] = std::move(pbr);

  if (const auto normal = textureInfo(material, aiTextureType_NORMALS)) result["normalTexture"] = *normal;
  if (const auto glow = textureInfo(material, aiTextureType_EMISSIVE)) result["emissiveTexture"] = *glow;
  const aiColor3D emissive = color(material, "$clr.emissive").value_or(aiColor3D(0, 0, 0));
  if (emissive.r > 0 || emissive.g > 0 || emissive.b > 0) {
    result["emissiveFactor"] = {unit(emissive.r, 0), unit(emissive.g, 0), unit(emissive.b, 0)};
  }
  if (opacity < 1) result["alphaMode"] = "BLEND";
  int twoSided = 0;
  if (material.Get(AI_MATKEY_TWOSIDED, twoSided) == aiReturn_SUCCESS && twoSided != 0) result["doubleSided"] = true;
  return result;
}

std::optional<Json> MaterialImporter::textureInfo(const aiMaterial& material, int kind) {
  aiString path;
  unsigned uvSet = 0;
  const auto type = static_cast<aiTextureType>(kind);
  if (material.GetTexture(type, 0, &path, nullptr, &uvSet) != aiReturn_SUCCESS || path.length == 0) return std::nullopt;
  const std::optional<Index> index = texture(std::string(path.data, path.length));
  if (!index) return std::nullopt;
  Json info = {{"index", *index}};
  if (uvSet > 0 && uvSet < AI_MAX_NUMBER_OF_TEXTURECOORDS) info["texCoord"] = uvSet;
  return info;
}

std::optional<Index> MaterialImporter::texture(const std::string& path) {
  const auto [known, isNew] = textures_.try_emplace(path);
  if (!isNew) return known->second;
  const std::optional<Bytes> bytes = imageBytes(path);
  if (!bytes) {
    asset_.warnings.add("missing-images", "textures that cannot be found are left out", validUtf8(path));
    return std::nullopt;
  }
  const std::string_view mime = imageFormat(*bytes).mediaType;
  if (mime.empty()) {
    asset_.warnings.add("unsupported-images", "textures that are neither PNG nor JPEG are left out", validUtf8(path));
    return std::nullopt;
  }
  const Index view = addImageView(asset_, *bytes);
  Json& json = asset_.json();
  json["images"].push_back({{"name", validUtf8(path)}, {"bufferView", view}, {"mimeType", mime}});
  json["textures"].push_back({{"source", json["images"].size() - 1}});
  return known->second = static_cast<Index>(json["textures"].size() - 1);
}

std::optional<Bytes> MaterialImporter::imageBytes(const std::string& path) {
  if (const aiTexture* embedded = scene_.GetEmbeddedTexture(path.c_str())) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
    if (embedded->mHeight == 0) return Bytes(data, data + embedded->mWidth);  // a whole image file
    return Bytes();                                                           // bare pixels: told as unsupported
  }
  return io_.sideFile(path);
}

}  // namespace limber
