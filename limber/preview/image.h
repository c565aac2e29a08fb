// A picture in memory, and as a PNG file.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limber/core/file.h"

namespace limber {

// width * height pixels, rows from the top, three bytes each: red, green, blue in sRGB.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

// Throws Error kBadArgument where the pixels do not fill the width and height, or these are not positive.
void checkSize(const Image& image);

// The same image gives the same bytes. Throws Error kBadArgument where the sizes do not match.
Bytes encodePng(const Image& image);

// Images of equal size side by side, `columns` in a row, left to right and top to bottom; `empty` fills the last row.
// Throws Error kBadArgument where there is none or sizes differ.
Image contactSheet(std::span<const Image> frames, int columns, const Image& empty);

}  // namespace limber
