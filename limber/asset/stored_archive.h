// ZIP archives, such as NumPy's of arrays and USDZ.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "limber/core/file.h"

namespace limber {

// By their paths, which are names and nothing is written to. Nothing in the archive is trusted; memory is at most the
// archive's own, or where files in it are deflated kMostInflatedPerByte times that. Throws Error kBadData where it is
// cut off or damaged, or holds a path twice; kUnsupported where a file in it is encrypted or compressed in another way,
// or the archive is a ZIP64; kLimit beyond 2 GB unpacked; where() is `name`.
std::map<std::string, Bytes> readZipArchive(ByteSpan bytes, std::string_view name);

struct StoredFile {
  std::string path;
  ByteSpan bytes;
};

// An archive of these files stored as they are, in their order, the bytes of each at a multiple of `alignment` (a power
// of two; USDZ asks for 64). Carries no times: same files, same bytes. Throws Error kLimit beyond 4 GB or 65535 files.
Bytes writeStoredArchive(std::span<const StoredFile> files, std::size_t alignment = 1);

}  // namespace limber
