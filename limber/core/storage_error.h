// What writeFiles throws where it is not the file's fault that it cannot be written.
#pragma once

#include "limber/core/error.h"

namespace limber {

// An Error kFile: there is no space left where the file is to lie, or the file system can only be read, or fails. Other
// files would fare alike.
class StorageError : public Error {
 public:
  using Error::Error;
};

}  // namespace limber
