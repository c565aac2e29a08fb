// The files of a ZIP archive that are stored in it as they are, as numpy.savez writes its arrays.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "limber/core/file.h"

namespace limber {

// By their paths, which are names and nothing is written to. Nothing in the archive is trusted; memory is at most the
// archive's own. Throws Error kBadData where it is cut off or damaged, or holds a path twice; kUnsupported where a file
// in it is compressed or encrypted, or the archive is a ZIP64; where() is `name`.
std::map<std::string, Bytes> readStoredArchive(ByteSpan bytes, std::string_view name);

}  // namespace limber
