#include "limber/actions/transfer/texture_bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"

namespace limber {

namespace {

constexpr double kOnEdge = 1e-6;  // barycentric: pixels this near to an edge may belong to a neighbour, too
constexpr int kGutter = 8;        // pixels

double crossOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Puts the triangles' pixels into a picture, one after the other.
class TexelRaster {
 public:
  explicit TexelRaster(int size) : size_(size), texelOf_(std::size_t(size) * std::size_t(size), kNoIndex) {}

  // False where it reaches beyond the picture or covers what another one does.
  bool add(std::size_t triangle, const std::array<Eigen::Vector2d, 3>& corners) {
    Eigen::Vector2d least = corners[0], most = corners[0];
    for (const Eigen::Vector2d& corner : corners) {
      least = least.cwiseMin(corner);
      most = most.cwiseMax(corner);
    }
    if (!(least.minCoeff() >= 0) || !(most.maxCoeff() <= size_)) return false;
    const double area = crossOf(corners[1] - corners[0], corners[2] - corners[0]);
    if (area == 0) return true;
    const auto first = [&](double x) { return std::max(0, static_cast<int>(std::floor(x - 0.5))); };
    const auto last = [&](double x) { return std::min(size_ - 1, static_cast<int>(std::ceil(x - 0.5))); };
    for (int y = first(least.y()); y <= last(most.y()); ++y) {
      for (int x = first(least.x()); x <= last(most.x()); ++x) {
        const Eigen::Vector2d at(x + 0.5, y + 0.5);
        Vec3 weights;
        for (std::size_t k = 0; k < 3; ++k) {
          const Eigen::Vector2d &next = corners[(k + 1) % 3], &other = corners[(k + 2) % 3];
          weights[static_cast<Eigen::Index>(k)] = crossOf(next - at, other - at) / area;
        }
        if (weights.minCoeff() >= 0 && !put(x, y, triangle, weights)) return false;
      }
    }
    return true;
  }

  std::vector<Texel> texels() const {
    std::vector<Texel> result;
    for (const Index texel : texelOf_) {
      if (texel != kNoIndex) result.push_back(texels_[texel]);
    }
    return result;
  }

 private:
  bool put(int x, int y, std::size_t triangle, const Vec3& weights) {
    const std::size_t pixel = std::size_t(size_) * std::size_t(y) + std::size_t(x);
    if (texelOf_[pixel] != kNoIndex) {
      return weights.minCoeff() < kOnEdge || texels_[texelOf_[pixel]].weights.minCoeff() < kOnEdge;
    }
    texelOf_[pixel] = static_cast<Index>(texels_.size());
    texels_.push_back({pixel, triangle, weights});
    return true;
  }

  int size_;
  std::vector<Index> texelOf_;  // by pixel
  std::vector<Texel> texels_;   // as they were found
};

}  // namespace

std::optional<std::vector<Texel>> texelsOf(std::span<const Triangle> triangles, std::span<const Vec2f> uvs, int size) {
  TexelRaster raster(size);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<Eigen::Vector2d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = size * uvs[triangles[t][k]].cast<double>();
    if (!raster.add(t, corners)) return std::nullopt;
  }
  return raster.texels();
}

std::vector<Vec3f> pictureOf(std::span<const Texel> texels, std::span<const Vec3f> colors, int size) {
  std::vector<Vec3f> picture(std::size_t(size) * std::size_t(size), Vec3f::Zero());
  std::vector<bool> isKnown(picture.size(), false);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    picture[texels[i].pixel] = colors[i];
    isKnown[texels[i].pixel] = true;
  }
  const auto pixelAt = [&](int x, int y) { return std::size_t(size) * std::size_t(y) + std::size_t(x); };
  for (int round = 0; round < kGutter; ++round) {
    std::vector<std::pair<std::size_t, Vec3f>> found;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        if (isKnown[pixelAt(x, y)]) continue;
        Vec3f sum = Vec3f::Zero();
        int count = 0;
        for (int v = std::max(0, y - 1); v <= std::min(size - 1, y + 1); ++v) {
          for (int u = std::max(0, x - 1); u <= std::min(size - 1, x + 1); ++u) {
            if (!isKnown[pixelAt(u, v)]) continue;
            sum += picture[pixelAt(u, v)];
            ++count;
          }
        }
        if (count > 0) found.emplace_back(pixelAt(x, y), sum / static_cast<float>(count));
      }
    }
    for (const auto& [pixel, color] : found) {
      picture[pixel] = color;
      isKnown[pixel] = true;
    }
  }
  return picture;
}

void setBaseColorPicture(Asset& asset, Index material, ByteSpan png) {
  gltf::Document& document = asset.document;
  gltf::Image image;
  image.bufferView = addBufferView(asset, png);
  image.mimeType = "image/png";
  gltf::Sampler sampler;
  sampler.wrapS = sampler.wrapT = gltf::kClampToEdge;
  gltf::Texture texture;
  texture.sampler = addElement(document.samplers, std::move(sampler));
  texture.source = addElement(document.images, std::move(image));
  gltf::Material& target = document.materials[material];
  if (!target.pbrMetallicRoughness) target.pbrMetallicRoughness.emplace();
  target.pbrMetallicRoughness->baseColorTexture.emplace().index = addElement(document.textures, std::move(texture));
}

}  // namespace limber
