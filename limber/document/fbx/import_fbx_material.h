// FBX materials and textures as glTF's.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/fbx/import_fbx_objects.h"
#include "limber/document/read.h"

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
  // The object of class Texture that is connected to a property.
  std::optional<Index> textureOf(Index object, std::string_view property);
  std::optional<gltf::TextureUse> textureUse(Index object, std::span<const std::string_view> properties,
                                             const std::vector<std::string>& textureSets);
  std::optional<Index> texture(Index object);
  // The image of a texture object: one for all textures with the same source.
  std::optional<Index> image(Index texture);
  void warnOfOthers(Index object);
  bool allBlack() const;

  Asset& asset_;
  const FbxObjects& objects_;
  const Resolver& resolver_;
  bool areAllBlack_;
  std::map<std::pair<Index, std::vector<std::string>>, Index> materials_;
  std::map<Index, std::optional<Index>> textures_, imageOfVideo_;  // by object
  std::map<std::string, std::optional<Index>> imageOfFile_;        // by its name in the file
  std::set<std::string_view> others_;                              // properties whose textures are left out
  std::optional<Index> default_;
};

}  // namespace limber
