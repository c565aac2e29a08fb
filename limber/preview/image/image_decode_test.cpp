#include "limber/preview/image/image_decode.h"

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>
#include <jpeglib.h>

#include "limber/preview/testing/rgba_png.h"

namespace limber {
namespace {

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int value : {40 + 3 * x, 60 + 2 * y, 120}) image.pixels.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return image;
}

Bytes jpegOf(const Image& image, bool progressive) {
  jpeg_compress_struct info = {};
  jpeg_error_mgr errors = {};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &buffer, &size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 98, TRUE);
  if (progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.pixels.data()) + std::size_t{info.next_scanline} * info.image_width * 3;
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  Bytes bytes(buffer, buffer + size);
  std::free(buffer);
  return bytes;
}

TEST(DecodeImage, ReadsPngAsItWasWritten) {
  const Image image = gradient(19, 7);
  const std::optional<DecodedImage> read = decodeImage(encodePng(image));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->colors.width, 19);
  EXPECT_EQ(read->colors.height, 7);
  EXPECT_EQ(read->colors.pixels, image.pixels);
}

TEST(DecodeImage, KeepsAlphaWhereThereIsAny) {
  const std::vector<std::uint8_t> rgba = {9, 8, 7, 0, 6, 5, 4, 255, 3, 2, 1, 99, 0, 50, 100, 255};
  const std::optional<DecodedImage> read = decodeImage(testing::rgbaPng(2, 2, rgba));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->colors.pixels, (std::vector<std::uint8_t>{9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 50, 100}));
  EXPECT_EQ(read->alpha, (std::vector<std::uint8_t>{0, 255, 99, 255}));
  const std::optional<DecodedImage> opaque = decodeImage(testing::rgbaPng(1, 1, {1, 2, 3, 255}));
  ASSERT_TRUE(opaque);
  EXPECT_TRUE(opaque->alpha.empty());
}

TEST(DecodeImage, ReadsJpegNearly) {
  const Image image = gradient(33, 21);
  for (const bool progressive : {false, true}) {
    const std::optional<DecodedImage> read = decodeImage(jpegOf(image, progressive));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->colors.width, 33);
    EXPECT_EQ(read->colors.height, 21);
    ASSERT_EQ(read->colors.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) EXPECT_NEAR(read->colors.pixels[i], image.pixels[i], 6) << i;
  }
}

TEST(DecodeImage, WhatIsNoWholeImageIsNone) {
  EXPECT_FALSE(decodeImage(Bytes{}));
  EXPECT_FALSE(decodeImage(Bytes{'G', 'I', 'F', '8', '9', 'a'}));
  // What has all pixels may lack its end mark.
  const Image image = gradient(9, 9);
  const Bytes png = encodePng(image);
  for (std::size_t length = 0; length < png.size(); ++length) {
    const std::optional<DecodedImage> read = decodeImage(ByteSpan(png).first(length));
    EXPECT_FALSE(read && read->colors.pixels != image.pixels) << length;
    EXPECT_FALSE(read && length < 60) << length;
  }
  // A JPEG that ends early is filled up with grey, as browsers do; its header must be whole.
  const Bytes jpeg = jpegOf(gradient(9, 9), false);
  for (std::size_t length = 0; length < 300; ++length) EXPECT_FALSE(decodeImage(ByteSpan(jpeg).first(length)));
}

TEST(DecodeImage, ASmallFileCannotAskForMuchMemory) {
  Bytes png = encodePng(gradient(9, 9));
  png[18] = png[22] = 0x40;  // 16384 more in width and height
  EXPECT_FALSE(decodeImage(png));
  Bytes jpeg = jpegOf(gradient(9, 9), true);
  for (std::size_t i = 0; i + 8 < jpeg.size(); ++i) {
    if (jpeg[i] == 0xff && jpeg[i + 1] == 0xc2) jpeg[i + 5] = jpeg[i + 7] = 0xf0;  // the frame's height and width
  }
  EXPECT_FALSE(decodeImage(jpeg));
}

}  // namespace
}  // namespace limber
