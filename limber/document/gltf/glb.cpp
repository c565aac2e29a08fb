#include "limber/document/gltf/glb.h"

#include <bit>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "limber/core/known_error.h"

namespace limber {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian and is read in place");

namespace {

constexpr std::uint32_t kMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJson = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinary = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;

std::uint32_t word(ByteSpan bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

std::size_t padded(std::size_t size) {
  return (size + 3) / 4 * 4;
}

// The part of the file that its header speaks of.
ByteSpan checkHeader(ByteSpan file, Warnings& warnings) {
  if (file.size() < kHeaderSize) {
    throw KnownError(ErrorKind::kCutFile, {ErrorCode::kBadData, "GLB is cut off inside its header"});
  }
  if (const std::uint32_t version = word(file, 4); version != 2) {
    throw Error(ErrorCode::kUnsupported, fmt::format("GLB is of version {}, limber reads version 2", version), {},
                "export the model as glTF 2.0");
  }
  const std::size_t length = word(file, 8);
  if (length < kHeaderSize) throw Error(ErrorCode::kBadData, fmt::format("GLB gives its length as {}", length));
  if (length > file.size()) {
    throw KnownError(
        ErrorKind::kCutFile,
        {ErrorCode::kBadData, fmt::format("GLB is cut off: it should have {} bytes and has {}", length, file.size())});
  }
  if (length < file.size()) {
    warnings.add("trailing-bytes", "bytes behind the end of the GLB left out", {}, file.size() - length);
  }
  return file.first(length);
}

void append(Bytes& bytes, std::uint32_t value) {
  bytes.resize(bytes.size() + sizeof(value));
  std::memcpy(bytes.data() + bytes.size() - sizeof(value), &value, sizeof(value));
}

}  // namespace

bool looksLikeGlb(ByteSpan bytes) {
  return bytes.size() >= 4 && word(bytes, 0) == kMagic;
}

GlbChunks splitGlb(ByteSpan file, Warnings& warnings) {
  file = checkHeader(file, warnings);
  GlbChunks chunks;
  bool first = true;
  std::size_t at = kHeaderSize;
  while (at < file.size()) {
    if (file.size() - at < kChunkHeaderSize) throw Error(ErrorCode::kBadData, "GLB is cut off inside a chunk's header");
    const std::size_t size = word(file, at);
    const std::uint32_t type = word(file, at + 4);
    at += kChunkHeaderSize;
    if (size > file.size() - at) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("GLB chunk should have {} bytes, but {} are left", size, file.size() - at));
    }
    if (first != (type == kJson)) {
      throw Error(ErrorCode::kBadData, first ? "GLB does not start with a JSON chunk" : "GLB has a second JSON chunk");
    }
    const ByteSpan content = file.subspan(at, size);
    if (type == kJson) {
      chunks.json = content;
    } else if (type == kBinary && !chunks.binary) {
      chunks.binary = content;
    } else {
      warnings.add("unknown-chunks", "further chunks of the GLB left out");
    }
    first = false;
    at += size;
  }
  if (first) throw Error(ErrorCode::kBadData, "GLB has no JSON chunk");
  return chunks;
}

std::size_t BinaryChunk::add(ByteSpan bytes) {
  static constexpr std::uint8_t kZeros[3] = {};
  const std::size_t start = padded(size);
  pieces.push_back(bytes);
  if (const std::size_t behind = padded(bytes.size()) - bytes.size(); behind > 0) pieces.push_back({kZeros, behind});
  size = start + bytes.size();
  return start;
}

Bytes glbHead(std::string_view json, const BinaryChunk& binary) {
  const std::size_t jsonSize = padded(json.size()), binarySize = padded(binary.size);
  const std::size_t binaryChunk = binary.size == 0 ? 0 : kChunkHeaderSize + binarySize;
  const std::size_t length = kHeaderSize + kChunkHeaderSize + jsonSize + binaryChunk;
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::kLimit, "the model is too large for a GLB (4 GiB)", {}, "write it as .gltf");
  }
  Bytes head;
  append(head, kMagic);
  append(head, 2);
  append(head, static_cast<std::uint32_t>(length));
  append(head, static_cast<std::uint32_t>(jsonSize));
  append(head, kJson);
  head.insert(head.end(), json.begin(), json.end());
  head.resize(kHeaderSize + kChunkHeaderSize + jsonSize, ' ');
  if (binaryChunk > 0) {
    append(head, static_cast<std::uint32_t>(binarySize));
    append(head, kBinary);
  }
  return head;
}

}  // namespace limber
