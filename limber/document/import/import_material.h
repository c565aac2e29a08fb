// Assimp's materials and textures as glTF's.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/import/import_io.h"

struct aiMaterial;
struct aiScene;

namespace limber {

// Adds materials, and the textures that they use, to one document. Textures are embedded.
class MaterialImporter {
 public:
  MaterialImporter(Asset& asset, const aiScene& scene, const ImportIo& io) : asset_(asset), scene_(scene), io_(io) {}

  // The glTF material of one of the scene's; made at the first call for it.
  Index material(unsigned index);

 private:
  gltf::Material convert(const aiMaterial& material);
  // The first texture of that kind; none where there is none or it cannot be had.
  std::optional<gltf::TextureUse> textureUse(const aiMaterial& material, int kind);
  std::optional<Index> texture(const std::string& path);
  std::optional<Bytes> imageBytes(const std::string& path);

  Asset& asset_;
  const aiScene& scene_;
  const ImportIo& io_;
  std::map<unsigned, Index> materials_;
  std::map<std::string, std::optional<Index>> textures_;
  std::set<std::size_t> pictures_;  // hashes of those that were read: one under many names counts once
};

}  // namespace limber
