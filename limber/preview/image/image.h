// A picture in memory, and as a PNG file.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limber/core/file/file.h"

namespace limber {

// width * height pixels, rows from the top: red, green and blue in sRGB, and where there are four channels how much
// that covers (not multiplied in). A byte each.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
  std::size_t channels = 3;
};

// Throws Error kBadArgument where the pixels do not fill the width and height, these are not positive, or there are not
// three or four channels.
void checkSize(const Image& image);

// The same image gives the same bytes. Throws Error kBadArgument where the sizes do not match.
Bytes encodePng(const Image& image);

// Images of equal size and channels side by side, `columns` in a row, left to right and top to bottom; `empty` fills
// the last row. Throws Error kBadArgument where there is none or sizes differ.
Image contactSheet(std::span<const Image> frames, int columns, const Image& empty);

}  // namespace limber
