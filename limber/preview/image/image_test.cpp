#include "limber/preview/image/image.h"

#include <gtest/gtest.h>
#include <png.h>

#include "limber/core/error.h"

namespace limber {
namespace {

Image gradient(int width, int height, int shift) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) image.pixels.push_back(static_cast<std::uint8_t>(i * 7 + shift));
  return image;
}

TEST(EncodePng, IsReadBackByAnotherDecoder) {
  const Image image = gradient(17, 9, 3);
  const Bytes bytes = encodePng(image);
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()));
  EXPECT_EQ(header.width, 17u);
  EXPECT_EQ(header.height, 9u);
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(header));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(pixels, image.pixels);
}

TEST(EncodePng, RefusesPixelsThatDoNotFillTheImage) {
  EXPECT_THROW(encodePng({4, 4, std::vector<std::uint8_t>(47)}), Error);
  EXPECT_THROW(encodePng({0, 0, {}}), Error);
}

TEST(ContactSheet, PlacesFramesRowByRowAndFillsTheLastRow) {
  const std::vector<Image> frames = {gradient(2, 2, 10), gradient(2, 2, 20), gradient(2, 2, 30)};
  const Image empty = gradient(2, 2, 40), sheet = contactSheet(frames, 2, empty);
  EXPECT_EQ(sheet.width, 4);
  EXPECT_EQ(sheet.height, 4);
  const auto pixel = [&](int x, int y) { return sheet.pixels[std::size_t((y * 4 + x) * 3)]; };
  EXPECT_EQ(pixel(0, 0), frames[0].pixels[0]);
  EXPECT_EQ(pixel(1, 1), frames[0].pixels[9]);
  EXPECT_EQ(pixel(2, 0), frames[1].pixels[0]);
  EXPECT_EQ(pixel(0, 2), frames[2].pixels[0]);
  EXPECT_EQ(pixel(2, 2), empty.pixels[0]);
  EXPECT_EQ(pixel(3, 3), empty.pixels[9]);
}

TEST(ContactSheet, RefusesFramesOfDifferentSizeAndNone) {
  const Image one = gradient(2, 2, 0), other = gradient(3, 2, 0);
  EXPECT_THROW(contactSheet(std::vector<Image>{one, other}, 2, one), Error);
  EXPECT_THROW(contactSheet(std::vector<Image>{one, one}, 2, other), Error);
  EXPECT_THROW(contactSheet({}, 2, one), Error);
}

}  // namespace
}  // namespace limber
