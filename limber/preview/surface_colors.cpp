#include "limber/preview/surface_colors.h"

#include "limber/preview/image/image.h"
#include "limber/preview/image/palette.h"

namespace limber {

bool hasColors(const Asset& asset) {
  for (const gltf::Mesh& mesh : asset.document.meshes) {
    for (const gltf::Primitive& primitive : mesh.primitives) {
      if (primitive.attributes.find("COLOR_0")) return true;
      if (!primitive.material) continue;
      const auto& surface = asset.document.materials[*primitive.material].pbrMetallicRoughness;
      if (surface && (surface->baseColorTexture || surface->baseColorFactor)) return true;
    }
  }
  return false;
}

SurfaceColors::SurfaceColors(const Character& character) : scene_(makeScene(character)) {}

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
