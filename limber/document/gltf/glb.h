// The GLB container: a header, a JSON chunk, and at most one binary chunk.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/file/file.h"

namespace limber {

bool looksLikeGlb(ByteSpan bytes);

// The chunks, as spans into the file. Further chunks are left out with a warning, as are bytes behind the end.
// Throws Error kBadData on a container that is cut off or inconsistent, kUnsupported on another version than 2.
struct GlbChunks {
  ByteSpan json;
  std::optional<ByteSpan> binary;
};
GlbChunks splitGlb(ByteSpan file, Warnings& warnings);

// What the binary chunk is written from: pieces one behind the other, each at a multiple of 4 bytes. They are referred
// to, not copied, and must outlive this.
struct BinaryChunk {
  std::vector<ByteSpan> pieces;  // and zeros behind each that needs them
  std::size_t size = 0;          // without the zeros behind the last

  // Returns where the piece begins.
  std::size_t add(ByteSpan bytes);
};

// A GLB until the first byte of its binary chunk. Throws Error kLimit where the file would reach 4 GiB, which the
// container cannot say.
Bytes glbHead(std::string_view json, const BinaryChunk& binary);

}  // namespace limber
