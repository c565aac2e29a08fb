// What writing throws where it is not the file's fault that it cannot be written.
#pragma once

#include <filesystem>
#include <string_view>

#include "limber/core/error.h"

namespace limber {

// An Error kFile: there is no space left where the file is to lie, or the file system can only be read, or fails. Other
// files would fare alike.
class StorageError : public Error {
 public:
  using Error::Error;
};

// Throws what tells that `path` "cannot be written" for a reason (an errno): a StorageError where it is one of these,
// else an Error kFile.
[[noreturn]] void failToWrite(const std::filesystem::path& path, int reason,
                              std::string_view what = "cannot be written");

}  // namespace limber
