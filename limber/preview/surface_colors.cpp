#include "limber/preview/surface_colors.h"

#include <nlohmann/json.hpp>

#include "limber/asset/scene_graph.h"
#include "limber/preview/image.h"
#include "limber/preview/palette.h"

namespace limber {

bool hasColors(const Asset& asset) {
  for (const Json& mesh : elements(asset, "meshes")) {
    for (const Json& primitive : mesh.at("primitives")) {
      if (primitive.at("attributes").contains("COLOR_0")) return true;
      const auto material = indexMember(primitive, "material");
      const Json* base = material ? member(elements(asset, "materials")[*material], "pbrMetallicRoughness") : nullptr;
      if (base && (base->contains("baseColorFactor") || base->contains("baseColorTexture"))) return true;
    }
  }
  return false;
}

SurfaceColors::SurfaceColors(const Asset& asset) : scene_(makeScene(asset)) {}

Vec3f SurfaceColors::at(Index triangle, const Vec3& weights) const {
  const Triangle& corners = scene_.triangles[triangle];
  Vec3f color = Vec3f::Zero();
  Vec2f uv = Vec2f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto weight = static_cast<float>(weights[static_cast<Eigen::Index>(k)]);
    color += weight * scene_.colors[corners[k]];
    if (!scene_.uvs.empty()) uv += weight * scene_.uvs[corners[k]];
  }
  const Index material = scene_.materialOf.empty() ? kNoIndex : scene_.materialOf[triangle];
  if (material == kNoIndex || !scene_.materials[material].texture) return color;
  return color.cwiseProduct(scene_.materials[material].texture->sample(uv, 0).cast<float>());
}

Bytes pngOfColors(int size, std::span<const Vec3f> pixels) {
  Image image{size, size, {}};
  for (const Vec3f& pixel : pixels) {
    for (int channel = 0; channel < 3; ++channel) image.pixels.push_back(srgbByte(double{pixel[channel]}));
  }
  return encodePng(image);
}

}  // namespace limber
