#include "limber/document/import/import_io.h"

#include <algorithm>

#include <assimp/MemoryIOWrapper.h>

#include "limber/core/text/names.h"
#include "limber/document/import/import_obj.h"
#include "limber/document/side_file.h"

namespace limber {

std::optional<Bytes> ImportIo::sideFile(std::string_view path) const {
  for (const std::string& folder : materialFolders_) {
    if (std::optional<Bytes> bytes = sideFileThere(resolver_, folder + std::string(path))) return bytes;
  }
  return limber::sideFile(resolver_, path);
}

const Bytes* ImportIo::cached(const std::string& path) const {
  auto known = sideFiles_.find(path);
  if (known == sideFiles_.end()) known = sideFiles_.emplace(path, sideFile(path)).first;
  return known->second ? &*known->second : nullptr;
}

bool ImportIo::Exists(const char* path) const {
  return path == mainName_ || cached(path) != nullptr;
}

Assimp::IOStream* ImportIo::Open(const char* path, const char*) {
  if (path == mainName_) return new Assimp::MemoryIOStream(mainFile_.data(), mainFile_.size());
  const Bytes* bytes = cached(path);
  if (!bytes && !missingFile_) missingFile_ = path;
  if (bytes && lowerExtension(path) == ".mtl") {
    movedTextures_ += countMovedMtlTextures(*bytes);
    const std::string location(path);
    const std::size_t slash = location.find_last_of("/\\");
    const std::string folder = slash == location.npos ? "" : location.substr(0, slash + 1);
    const bool isKnown = std::find(materialFolders_.begin(), materialFolders_.end(), folder) != materialFolders_.end();
    if (!folder.empty() && !isKnown) materialFolders_.push_back(folder);
  }
  return bytes ? new Assimp::MemoryIOStream(bytes->data(), bytes->size()) : nullptr;
}

void ImportIo::Close(Assimp::IOStream* stream) {
  delete stream;
}

}  // namespace limber
