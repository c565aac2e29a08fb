#include "limber/preview/image/image.h"

#include <png.h>

#include <algorithm>
#include <cstddef>

#include "limber/core/error.h"

namespace limber {

void checkSize(const Image& image) {
  const bool sized = image.width > 0 && image.height > 0 && (image.channels == 3 || image.channels == 4) &&
                     image.pixels.size() == image.channels * std::size_t(image.width) * std::size_t(image.height);
  if (!sized) throw Error(ErrorCode::kBadArgument, "an image's pixels do not match its width and height");
}

Bytes encodePng(const Image& image) {
  checkSize(image);
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = image.channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  Bytes bytes(size);
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr)) {
    throw Error(ErrorCode::kFile, std::string("the picture cannot be written: ") + header.message);
  }
  bytes.resize(size);
  return bytes;
}

Image contactSheet(std::span<const Image> frames, int columns, const Image& empty) {
  if (frames.empty() || columns < 1)
    throw Error(ErrorCode::kBadArgument, "a contact sheet needs a picture and a column");
  const auto checkFits = [&](const Image& frame) {
    checkSize(frame);
    if (frame.width != frames[0].width || frame.height != frames[0].height || frame.channels != frames[0].channels) {
      throw Error(ErrorCode::kBadArgument, "the pictures of a contact sheet differ in size");
    }
  };
  std::for_each(frames.begin(), frames.end(), checkFits);
  checkFits(empty);
  const int count = static_cast<int>(frames.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  Image sheet{columns * frames[0].width, rows * frames[0].height, {}, frames[0].channels};
  const std::size_t frameStride = sheet.channels * std::size_t(frames[0].width);
  const std::size_t sheetStride = frameStride * std::size_t(columns);
  sheet.pixels.resize(sheetStride * std::size_t(sheet.height));
  for (int i = 0; i < rows * columns; ++i) {
    const Image& frame = i < count ? frames[std::size_t(i)] : empty;
    for (int y = 0; y < frame.height; ++y) {
      const std::size_t row = std::size_t(i / columns) * std::size_t(frame.height) + std::size_t(y);
      std::copy_n(frame.pixels.begin() + static_cast<std::ptrdiff_t>(frameStride * std::size_t(y)), frameStride,
                  sheet.pixels.begin() +
                      static_cast<std::ptrdiff_t>(row * sheetStride + std::size_t(i % columns) * frameStride));
    }
  }
  return sheet;
}

}  // namespace limber
