// A whole file to look at, in memory only where it is looked at.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "limber/core/file/file.h"

namespace limber {

// A plain file of `mapFrom` bytes or more is mapped where the system has that: its pages come as they are looked at and
// can go again, so that a file may be as large as memory. Anything else is read as readFile does: small files, pipes,
// standard input ("-"). Throws as readFile does.
//
// Nobody may truncate a mapped file meanwhile: the system ends a program that reads past the new end. writeFile
// replaces the old file with a new one and does no harm.
class FileView {
 public:
  static constexpr std::size_t kMapFrom = std::size_t{16} << 20;  // below that a copy costs some 5 ms

  explicit FileView(const std::filesystem::path& path, std::size_t mapFrom = kMapFrom);
  ~FileView();

  ByteSpan bytes() const { return bytes_; }
  bool isMapped() const { return mapping_ != nullptr; }

 private:
  class Mapping;

  std::unique_ptr<Mapping> mapping_;
  Bytes read_;
  ByteSpan bytes_;
};

}  // namespace limber
