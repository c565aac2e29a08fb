#include "limber/preview/image/apng.h"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <string>

#include "limber/core/error.h"

namespace limber {
namespace {

Image noise(int width, int height, unsigned seed) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) {
    seed = seed * 1664525u + 1013904223u;
    image.pixels.push_back(static_cast<std::uint8_t>(seed >> 24));
  }
  return image;
}

std::uint32_t word(const Bytes& bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 | std::uint32_t{bytes[at + 2]} << 8 |
         bytes[at + 3];
}

struct Chunk {
  std::string type;
  Bytes data;
};

// The chunks of a file, each with a checksum that zlib agrees with.
std::vector<Chunk> chunksOf(const Bytes& file) {
  std::vector<Chunk> chunks;
  std::size_t at = 8;
  while (at < file.size()) {
    const std::size_t size = word(file, at);
    chunks.push_back({std::string(file.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                                  file.begin() + static_cast<std::ptrdiff_t>(at) + 8),
                      Bytes(file.begin() + static_cast<std::ptrdiff_t>(at) + 8,
                            file.begin() + static_cast<std::ptrdiff_t>(at + 8 + size))});
    EXPECT_EQ(word(file, at + 8 + size), crc32(0, file.data() + at + 4, static_cast<uInt>(size + 4)));
    at += 12 + size;
  }
  EXPECT_EQ(at, file.size());
  return chunks;
}

std::vector<std::uint8_t> decode(const Bytes& png) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&header, png.data(), png.size())) return {};
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(header));
  if (!png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr)) return {};
  return pixels;
}

// Rows, inflated by zlib itself, must be the frame's: filter byte and pixels, any filter.
std::size_t inflatedSize(const Bytes& stream, std::size_t expected) {
  Bytes rows(expected + 1);
  uLongf size = static_cast<uLongf>(rows.size());
  return uncompress(rows.data(), &size, stream.data(), static_cast<uLong>(stream.size())) == Z_OK ? size : 0;
}

TEST(EncodeApng, HoldsEveryFrame) {
  std::vector<Image> frames;
  for (unsigned i = 0; i < 5; ++i) frames.push_back(noise(40, 30, i));
  const Bytes file = encodeApng(frames, 25);
  EXPECT_EQ(decode(file), frames[0].pixels) << "what shows where animation is not known";
  EXPECT_EQ(encodeApng(frames, 25), file);

  const std::vector<Chunk> chunks = chunksOf(file);
  EXPECT_EQ(chunks.front().type, "IHDR");
  EXPECT_EQ(chunks.back().type, "IEND");
  std::uint32_t sequence = 0, controls = 0;
  std::vector<Bytes> streams;
  for (const Chunk& chunk : chunks) {
    if (chunk.type == "acTL") {
      EXPECT_EQ(word(chunk.data, 0), 5u);
      EXPECT_EQ(controls, 0u);
    } else if (chunk.type == "fcTL") {
      EXPECT_EQ(word(chunk.data, 0), sequence++);
      EXPECT_EQ(word(chunk.data, 4), 40u);
      EXPECT_EQ(word(chunk.data, 8), 30u);
      const double numerator = chunk.data[20] * 256 + chunk.data[21],
                   denominator = chunk.data[22] * 256 + chunk.data[23];
      EXPECT_NEAR(numerator / denominator, 1 / 25.0, 1e-4);
      ++controls;
      streams.emplace_back();
    } else if (chunk.type == "IDAT") {
      ASSERT_EQ(controls, 1u);
      streams.back().insert(streams.back().end(), chunk.data.begin(), chunk.data.end());
    } else if (chunk.type == "fdAT") {
      EXPECT_EQ(word(chunk.data, 0), sequence++);
      ASSERT_GT(controls, 1u);
      streams.back().insert(streams.back().end(), chunk.data.begin() + 4, chunk.data.end());
    }
  }
  ASSERT_EQ(streams.size(), 5u);
  for (std::size_t i = 0; i < streams.size(); ++i) {
    EXPECT_EQ(inflatedSize(streams[i], 30 * (40 * 3 + 1)), std::size_t{30 * (40 * 3 + 1)});
    // As a PNG of its own it is the frame, by another decoder.
    Bytes rebuilt(file.begin(), file.begin() + 33);  // signature and header
    const auto add = [&](const std::string& type, const Bytes& data) {
      Bytes body(type.begin(), type.end());
      body.insert(body.end(), data.begin(), data.end());
      for (int shift = 24; shift >= 0; shift -= 8) rebuilt.push_back(static_cast<std::uint8_t>(data.size() >> shift));
      rebuilt.insert(rebuilt.end(), body.begin(), body.end());
      const uLong code = crc32(0, body.data(), static_cast<uInt>(body.size()));
      for (int shift = 24; shift >= 0; shift -= 8) rebuilt.push_back(static_cast<std::uint8_t>(code >> shift));
    };
    add("IDAT", streams[i]);
    add("IEND", {});
    EXPECT_EQ(decode(rebuilt), frames[i].pixels) << i;
  }
}

TEST(EncodeApng, RefusesWhatIsNoAnimation) {
  EXPECT_THROW(encodeApng({}, 25), Error);
  EXPECT_THROW(encodeApng(std::vector<Image>{noise(4, 4, 1), noise(5, 4, 1)}, 25), Error);
  EXPECT_THROW(encodeApng(std::vector<Image>{noise(4, 4, 1)}, 0), Error);
  EXPECT_NO_THROW(encodeApng(std::vector<Image>{noise(4, 4, 1)}, 0.1));
}

}  // namespace
}  // namespace limber
