// Files out of a ZIP archive, such as the studio's .limber files.
#pragma once

#include <map>
#include <string>

#include "limber/core/file.h"

namespace limber::cli {

bool isArchive(ByteSpan bytes);  // by how a ZIP begins

// By their paths. Throws Error kBadData, naming the archive and what is wrong: cut off or damaged, a path that leads
// out of it or is there twice, more than 1000 files, more than 2 GB in all, or more than 1000 bytes for each that is
// packed.
std::map<std::string, Bytes> readArchive(ByteSpan bytes, const std::string& name);

}  // namespace limber::cli
