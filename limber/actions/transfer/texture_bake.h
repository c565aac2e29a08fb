// Colours of a surface as a texture of its own texture coordinates.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/scene/geometry.h"

namespace limber {

// What the middle of a picture's pixel shows: a point of a triangle.
struct Texel {
  std::size_t pixel = 0;  // size * row + column, rows from the top as glTF's coordinates have them
  std::size_t triangle = 0;
  Vec3 weights = Vec3::Zero();  // of its corners, sum 1
};

// The texels of a square picture `size` wide, in the order of the pixels; the first triangle has a pixel on an edge.
// Nothing where triangles lie on each other or reach beyond the picture, so that one pixel would have to show two
// points.
// uvs  of all vertices, glTF's: (0, 0) is the upper left corner of the picture, (1, 1) the lower right one
// Cost: O(size^2 + the pixels of the triangles' boxes).
std::optional<std::vector<Texel>> texelsOf(std::span<const Triangle> triangles, std::span<const Vec2f> uvs, int size);

// A picture of size * size pixels out of the colours of its texels, in their order. Pixels beside these get the mean of
// what is known beside them, eight pixels far; so nothing foreign shows at a seam. The others are black.
std::vector<Vec3f> pictureOf(std::span<const Texel> texels, std::span<const Vec3f> colors, int size);

// The material shows that PNG file by TEXCOORD_0, clamped at its edges, as its base colour.
void setBaseColorPicture(Asset& asset, Index material, ByteSpan png);

}  // namespace limber
