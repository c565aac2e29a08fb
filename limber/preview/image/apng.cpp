// Every frame is encoded as a PNG of its own; its compressed rows are then moved into the chunks of one file.
#include "limber/preview/image/apng.h"

#include <array>
#include <cmath>
#include <string_view>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr std::size_t kSignatureSize = 8, kHeaderSize = 8, kChecksumSize = 4;  // of a file, a chunk, behind a chunk

std::uint32_t readWord(ByteSpan bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

void addWord(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void addShort(Bytes& bytes, std::uint32_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

// The cyclic redundancy code of PNG, annex D.
std::uint32_t checksum(ByteSpan bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table;
    for (std::uint32_t n = 0; n < 256; ++n) {
      table[n] = n;
      for (int bit = 0; bit < 8; ++bit) table[n] = (table[n] & 1 ? 0xedb88320u : 0u) ^ table[n] >> 1;
    }
    return table;
  }();
  std::uint32_t code = 0xffffffffu;
  for (const std::uint8_t byte : bytes) code = kTable[(code ^ byte) & 0xff] ^ code >> 8;
  return ~code;
}

void addChunk(Bytes& file, std::string_view type, ByteSpan data) {
  addWord(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = file.size();
  file.insert(file.end(), type.begin(), type.end());
  file.insert(file.end(), data.begin(), data.end());
  addWord(file, checksum(ByteSpan(file).subspan(begin)));
}

struct Chunk {
  std::string_view type;
  ByteSpan data;
};

std::vector<Chunk> chunksOf(ByteSpan png) {
  std::vector<Chunk> chunks;
  for (std::size_t at = kSignatureSize; at + kHeaderSize <= png.size();) {
    const std::size_t size = readWord(png.subspan(at, 4));
    const auto* type = reinterpret_cast<const char*>(png.data() + at + 4);
    chunks.push_back({{type, 4}, png.subspan(at + kHeaderSize, size)});
    at += kHeaderSize + size + kChecksumSize;
  }
  return chunks;
}

// How one frame is shown: all over the picture, replacing what was there.
Bytes frameControl(std::uint32_t sequence, const Image& image, double framesPerSecond) {
  constexpr double kTicks = 10000;  // a second, as far as the delay's two shorts allow
  Bytes data;
  addWord(data, sequence);
  addWord(data, static_cast<std::uint32_t>(image.width));
  addWord(data, static_cast<std::uint32_t>(image.height));
  addWord(data, 0);
  addWord(data, 0);
  const double ticks = framesPerSecond < 1 ? kTicks / 10 : kTicks;
  addShort(data, static_cast<std::uint32_t>(std::lround(ticks / framesPerSecond)));
  addShort(data, static_cast<std::uint32_t>(ticks));
  data.push_back(0);
  data.push_back(0);
  return data;
}

}  // namespace

Bytes encodeApng(std::span<const Image> frames, double framesPerSecond) {
  if (frames.empty()) throw Error(ErrorCode::kBadArgument, "an animation needs a picture");
  if (!(framesPerSecond >= 0.1 && framesPerSecond <= 1000)) {
    throw Error(ErrorCode::kBadArgument, "an animation has 0.1 to 1000 frames a second");
  }
  Bytes file;
  std::uint32_t sequence = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].width != frames[0].width || frames[i].height != frames[0].height ||
        frames[i].channels != frames[0].channels) {
      throw Error(ErrorCode::kBadArgument, "the pictures of an animation differ in size");
    }
    const Bytes png = encodePng(frames[i]);
    if (i == 0) file.assign(png.begin(), png.begin() + kSignatureSize);
    bool controlled = false;
    for (const Chunk& chunk : chunksOf(png)) {
      const bool rows = chunk.type == "IDAT";
      if (rows && i == 0 && !controlled) {
        Bytes control;
        addWord(control, static_cast<std::uint32_t>(frames.size()));
        addWord(control, 0);  // plays: for ever
        addChunk(file, "acTL", control);
      }
      if (rows && !controlled) addChunk(file, "fcTL", frameControl(sequence++, frames[i], framesPerSecond));
      controlled = controlled || rows;
      if (rows && i > 0) {
        Bytes data;
        addWord(data, sequence++);
        data.insert(data.end(), chunk.data.begin(), chunk.data.end());
        addChunk(file, "fdAT", data);
      } else if (rows || (i == 0 && chunk.type != "IEND")) {
        addChunk(file, chunk.type, chunk.data);
      }
    }
  }
  addChunk(file, "IEND", {});
  return file;
}

}  // namespace limber
