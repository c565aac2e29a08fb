// A picture that colours a surface: looked up by texture coordinates, without flicker where it is far away.
#pragma once

#include <vector>

#include "limber/core/types.h"
#include "limber/preview/image/image.h"

namespace limber {

// What is beyond an edge of the picture.
enum class TextureWrap { kRepeat, kMirror, kClamp };

class Texture {
 public:
  // Makes the smaller levels: each half as wide and high as the one before, down to one pixel, averaged in linear
  // light. Throws Error kBadArgument for an image whose pixels do not match its size. Cost: O(#pixels), 4/3 of their
  // memory.
  // alpha  a byte for each pixel, 255 where nothing shines through; empty: everywhere
  Texture(Image image, TextureWrap across, TextureWrap down, std::vector<std::uint8_t> alpha = {});

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }

  // Linear RGB at uv, glTF's coordinates: (0, 0) is the upper left corner of the picture, (1, 1) the lower right one.
  // level: 0 the whole picture, 1 half of its width and height, ...; clamped. Linear between the four nearest pixels
  // and between levels. Coordinates that are not finite count as 0.
  Vec3 sample(const Vec2f& uv, double level) const;

  // Of what is seen there, not of what is behind it. In [0, 1], linear between the four nearest pixels of the whole
  // picture.
  double alphaAt(const Vec2f& uv) const;

 private:
  // Calls add(pixel, weight) for the four pixels of a picture of that size that are nearest to uv.
  template <typename Add>
  void forNearestPixels(int width, int height, const Vec2f& uv, const Add& add) const;
  Vec3 sampleLevel(const Image& image, const Vec2f& uv) const;

  std::vector<Image> levels_;
  std::vector<std::uint8_t> alpha_;
  TextureWrap across_, down_;
};

}  // namespace limber
