#include "limber/core/file/storage_error.h"

#include <cerrno>
#include <cstring>
#include <string>

namespace limber {

namespace {

// Would other files fare alike?
bool isOfStorage(int reason) {
#ifdef EDQUOT
  if (reason == EDQUOT) return true;
#endif
  return reason == ENOSPC || reason == EROFS || reason == EIO;
}

}  // namespace

void failToWrite(const std::filesystem::path& path, int reason, std::string_view what) {
  const std::string problem = std::string(what) + ": " + std::strerror(reason);
  if (isOfStorage(reason)) throw StorageError(ErrorCode::kFile, problem, path.string());
  throw Error(ErrorCode::kFile, problem, path.string());
}

}  // namespace limber
