// FBX materials and textures as glTF's.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/asset/import_fbx_objects.h"
#include "limber/asset/read.h"

namespace limber {

// Adds materials, and the textures that they use, to one document. Textures are embedded.
class FbxMaterials {
 public:
  FbxMaterials(Asset& asset, const FbxObjects& objects, const Resolver& resolver);

  // The glTF material of an object, for a mesh with such sets of texture coordinates; made at the first call.
  Index material(Index object, const std::vector<std::string>& textureSets);
  // The grey one of what has none.
  Index defaultMaterial();

 private:
  gltf::Material convert(Index object, const std::vector<std::string>& textureSets);
  Vec3 colorOf(Index object, std::string_view color, std::string_view factor, double otherwise) const;
  double opacityOf(const FbxProperties& properties) const;
  // The object of class Texture that stands for a property.
  std::optional<Index> textureOf(Index object, std::string_view property);
  std::optional<gltf::TextureUse> textureUse(Index object, std::initializer_list<std::string_view> properties,
                                             const std::vector<std::string>& textureSets);
  std::optional<Index> texture(Index object);
  std::optional<Bytes> pictureOf(Index texture, std::string& path) const;
  bool allBlack() const;

  Asset& asset_;
  const FbxObjects& objects_;
  const Resolver& resolver_;
  bool areAllBlack_;
  std::map<std::pair<Index, std::vector<std::string>>, Index> materials_;
  std::map<Index, std::optional<Index>> textures_;  // by object
  std::optional<Index> default_;
};

}  // namespace limber
