// The GLB container: a header, a JSON chunk, and at most one binary chunk.
#pragma once

#include <optional>
#include <string_view>

#include "limber/core/error.h"
#include "limber/core/file.h"

namespace limber {

bool looksLikeGlb(ByteSpan bytes);

// The chunks, as spans into the file. Further chunks are left out with a warning, as are bytes behind the end.
// Throws Error kBadData on a container that is cut off or inconsistent, kUnsupported on another version than 2.
struct GlbChunks {
  ByteSpan json;
  std::optional<ByteSpan> binary;
};
GlbChunks splitGlb(ByteSpan file, Warnings& warnings);

// Throws Error kLimit where the file would reach 4 GiB, which the container cannot say.
Bytes joinGlb(std::string_view json, ByteSpan binary);

}  // namespace limber
