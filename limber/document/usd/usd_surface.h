// What UsdPreviewSurface can say of a glTF material.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/usd/usd_stage.h"

namespace limber {

// Where on a texture a point lies: scaled, then turned, then moved, with v upwards as USD has it.
struct UsdUvTransform {
  Vec2f scale = Vec2f::Ones();
  float degrees = 0;  // counter-clockwise
  Vec2f translation = Vec2f::Zero();

  bool operator==(const UsdUvTransform&) const = default;
};

// A texture as one or several inputs read it: its colour * scale + bias.
struct UsdTexture {
  Index texture = 0;  // of the document
  Index uvSet = 0;    // TEXCOORD_0, ...
  std::optional<UsdUvTransform> transform;
  Vec4f scale = Vec4f::Ones(), bias = Vec4f::Zero();
  bool isColor = false;  // stored as sRGB

  bool operator==(const UsdTexture&) const = default;
};

struct UsdInput {
  std::string type, name;  // "color3f", "diffuseColor"
  UsdValue value;          // where there is no texture, or it cannot be had; none: then the input is left out
  std::optional<UsdTexture> texture;
  std::string channel;  // of the texture: "rgb", "a"
};

struct UsdSurface {
  std::vector<UsdInput> inputs;
  std::set<Index> uvSets;  // that its textures ask for
  std::string colorInput;  // the one that has the base colour
  Vec4f baseColor = Vec4f::Ones();
  bool hasOpacity = false;          // blended or cut out
  bool isTextured = false;          // has the base colour a texture? USD multiplies none by colours of vertices
  std::vector<std::string> unsaid;  // extensions that are lost
};

// With KHR_texture_transform and KHR_materials_unlit, _emissive_strength, _ior, _clearcoat, _pbrSpecularGlossiness.
// Throws Error kBadData, with the path ("materials[3]"), where an extension breaks its format.
UsdSurface usdSurface(const gltf::Document& document, Index material);

}  // namespace limber
