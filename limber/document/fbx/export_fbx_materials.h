// A document's materials and pictures as FBX has them.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "limber/document/asset.h"
#include "limber/document/fbx/export_fbx_objects.h"

namespace limber {

// FBX knows Phong's materials: of glTF's there are left base colour, emission, normal map and opacity; metalness goes
// into ReflectionFactor and roughness into Shininess, by the formulas of Blender's exporter and importer. Colours are
// linear, as these two have them. Pictures are embedded as they are, PNG and JPEG alone.
class FbxMaterialWriter {
 public:
  FbxMaterialWriter(const Asset& asset, FbxObjectWriter& objects, Warnings& warnings)
      : asset_(asset), objects_(objects), warnings_(warnings) {}

  // The object of one of the document's materials, or of glTF's default one; made at the first call for it.
  FbxId material(std::optional<Index> number);

 private:
  void writeTextures(const gltf::Material& material, FbxId id);
  void connect(const gltf::TextureUse& use, FbxId material, std::string_view property);
  std::optional<FbxId> video(Index image);
  std::string fileOf(Index image, std::string_view extension) const;

  const Asset& asset_;
  FbxObjectWriter& objects_;
  Warnings& warnings_;
  std::map<std::optional<Index>, FbxId> materials_;
  std::map<Index, std::optional<FbxId>> videos_;  // by the document's images
  std::map<Index, std::string> files_;            // likewise
};

}  // namespace limber
