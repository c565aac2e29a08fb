// ZIP archives whose files are stored in them as they are, as numpy.savez writes its arrays and as USDZ is.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "limber/core/file.h"

namespace limber {

// By their paths, which are names and nothing is written to. Nothing in the archive is trusted; memory is at most the
// archive's own. Throws Error kBadData where it is cut off or damaged, or holds a path twice; kUnsupported where a file
// in it is compressed or encrypted, or the archive is a ZIP64; where() is `name`.
std::map<std::string, Bytes> readStoredArchive(ByteSpan bytes, std::string_view name);

struct StoredFile {
  std::string path;
  ByteSpan bytes;
};

// An archive of these files, in their order, the bytes of each at a multiple of `alignment` (a power of two; USDZ asks
// for 64). Carries no times: same files, same bytes. Throws Error kLimit beyond 4 GB or 65535 files.
Bytes writeStoredArchive(std::span<const StoredFile> files, std::size_t alignment = 1);

}  // namespace limber
