#include "limber/asset/import_io.h"

#include <algorithm>

#include <assimp/MemoryIOWrapper.h>

namespace limber {

namespace {

// "C:\models\.\skin.png" -> "C:/models/./skin.png".
std::string withSlashes(std::string_view path) {
  std::string result(path);
  std::replace(result.begin(), result.end(), '\\', '/');
  while (result.rfind("./", 0) == 0) result.erase(0, 2);
  return result;
}

bool isAbsolute(const std::string& path) {
  return path.rfind('/', 0) == 0 || path.find(':') != std::string::npos;
}

std::optional<Bytes> open(const Resolver& resolver, const std::string& path) {
  if (!resolver || path.empty() || isAbsolute(path)) return std::nullopt;
  try {
    return resolver(path);
  } catch (const Error&) {  // leads out of the model's folder, or cannot be read: as good as not there
    return std::nullopt;
  }
}

}  // namespace

std::optional<Bytes> ImportIo::sideFile(std::string_view path) const {
  const std::string name = withSlashes(path);
  if (std::optional<Bytes> bytes = open(resolver_, name)) return bytes;
  const std::size_t slash = name.find_last_of('/');
  return slash == std::string::npos ? std::nullopt : open(resolver_, name.substr(slash + 1));
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
  return bytes ? new Assimp::MemoryIOStream(bytes->data(), bytes->size()) : nullptr;
}

void ImportIo::Close(Assimp::IOStream* stream) {
  delete stream;
}

}  // namespace limber
