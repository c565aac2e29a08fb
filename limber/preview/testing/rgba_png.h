// A PNG with alpha, as encodePng does not write it.
#pragma once

#include <vector>

#include <png.h>

#include "limber/core/file/file.h"

namespace limber::testing {

// rgba  four bytes a pixel, rows from the top
inline Bytes rgbaPng(unsigned width, unsigned height, const std::vector<std::uint8_t>& rgba) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = width;
  header.height = height;
  header.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&header, nullptr, &size, 0, rgba.data(), 0, nullptr);
  Bytes png(size);
  png_image_write_to_memory(&header, png.data(), &size, 0, rgba.data(), 0, nullptr);
  return png;
}

}  // namespace limber::testing
