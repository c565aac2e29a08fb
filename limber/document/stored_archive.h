// ZIP archives, such as NumPy's of arrays and USDZ.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "limber/core/error.h"
#include "limber/core/file/file.h"

namespace limber {

bool looksLikeZipArchive(ByteSpan bytes);  // by how it begins

// What an archive holds, by paths, which are names and nothing is written to; a file is unpacked when it is asked for.
// Nothing in the archive is trusted.
class ZipArchive {
 public:
  // `bytes` outlive this. Throws Error kBadData where the directory is cut off or damaged, or names a path twice;
  // where() is `name`.
  ZipArchive(ByteSpan bytes, std::string_view name);

  // None where there is no such file. Throws Error kBadData where it is cut off or damaged; kUnsupported where it is
  // encrypted or compressed by another method than deflate, or the archive is a ZIP64; kLimit beyond maxUnpacked().
  std::optional<Bytes> find(const std::string& path) const;

  // All files whose paths `isAskedFor` takes; an empty function takes all. Throws as find does, kLimit where they have
  // more than maxUnpacked() together.
  using Asked = std::function<bool(const std::string& path)>;
  std::map<std::string, Bytes> files(const Asked& isAskedFor = {}) const;

  // In bytes: a fixed sum, and many times what the archive has itself. Files that are worth keeping are packed far
  // less.
  std::size_t maxUnpacked() const;

 private:
  struct Entry {
    std::size_t at;        // of its record in the directory
    std::size_t unpacked;  // bytes
  };

  [[noreturn]] void refuse(std::string what, ErrorCode code = ErrorCode::kBadData, std::string remedy = {}) const;
  std::uint32_t number(std::size_t at, std::size_t size) const;
  std::string text(std::size_t at, std::size_t size) const;
  std::size_t directoryEnd() const;
  void checkSize(std::uint64_t unpacked) const;
  Bytes contentOf(std::size_t entry, const std::string& path) const;

  ByteSpan bytes_;
  std::string name_;
  std::map<std::string, Entry> entries_;
};

// All files of an archive, of which `isAskedFor` takes the paths. Throws as ZipArchive does.
std::map<std::string, Bytes> readZipArchive(ByteSpan bytes, std::string_view name,
                                            const ZipArchive::Asked& isAskedFor = {});

struct StoredFile {
  std::string path;
  ByteSpan bytes;
};

// An archive of these files stored as they are, in their order, the bytes of each at a multiple of `alignment` (a power
// of two; USDZ asks for 64). Carries no times: same files, same bytes. Throws Error kLimit beyond 4 GB or 65535 files.
Bytes writeStoredArchive(std::span<const StoredFile> files, std::size_t alignment = 1);

}  // namespace limber
