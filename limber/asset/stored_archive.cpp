#include "limber/asset/stored_archive.h"

#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

// Signatures and sizes in bytes of the records that APPNOTE.TXT 6.3 (PKWARE) lays down.
constexpr std::uint32_t kLocalFile = 0x04034b50, kDirectoryEntry = 0x02014b50, kDirectoryEnd = 0x06054b50;
constexpr std::size_t kLocalSize = 30, kEntrySize = 46, kEndSize = 22, kMostComment = 65535;
constexpr std::uint32_t kInZip64 = 0xffffffff;  // in place of a number that stands elsewhere

class StoredArchive {
 public:
  StoredArchive(ByteSpan bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  std::map<std::string, Bytes> files() const {
    const std::size_t end = directoryEnd();
    const std::uint64_t count = number(end + 10, 2);
    std::size_t at = number(end + 16, 4);
    std::map<std::string, Bytes> files;
    std::size_t read = 0;  // entries that share their bytes would make memory grow beyond the archive
    for (std::uint64_t i = 0; i < count; ++i) {
      if (number(at, 4) != kDirectoryEntry) refuse("its directory is damaged");
      const std::size_t nameSize = number(at + 28, 2);
      std::string path = text(at + kEntrySize, nameSize);
      Bytes content = contentOf(at, path);
      read += content.size();
      if (read > bytes_.size()) refuse("files in it share their bytes");
      if (!files.emplace(path, std::move(content)).second) refuse(fmt::format("holds '{}' twice", path));
      at += kEntrySize + nameSize + number(at + 30, 2) + number(at + 32, 2);
    }
    return files;
  }

 private:
  [[noreturn]] void refuse(std::string what, ErrorCode code = ErrorCode::kBadData, std::string remedy = {}) const {
    throw Error(code, std::move(what), std::string(name_), std::move(remedy));
  }

  std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) refuse("is cut off, or no ZIP archive");
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t{bytes_[at + i]} << (8 * i);
    return value;
  }
  std::string text(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) refuse("is cut off, or no ZIP archive");
    return {reinterpret_cast<const char*>(bytes_.data()) + at, size};
  }

  // Behind it is a comment of any length, whose length it tells.
  std::size_t directoryEnd() const {
    for (std::size_t back = kEndSize; back <= bytes_.size() && back <= kEndSize + kMostComment; ++back) {
      const std::size_t at = bytes_.size() - back;
      if (number(at, 4) == kDirectoryEnd && number(at + 20, 2) == back - kEndSize) return at;
    }
    refuse("is cut off, or no ZIP archive");
  }

  Bytes contentOf(std::size_t entry, const std::string& path) const {
    if (number(entry + 8, 2) % 2 == 1) refuse(fmt::format("'{}' in it is encrypted", path), ErrorCode::kUnsupported);
    const std::uint32_t size = number(entry + 24, 4), local = number(entry + 42, 4);
    if (number(entry + 10, 2) != 0) {
      refuse(fmt::format("'{}' in it is compressed", path), ErrorCode::kUnsupported, "save it by numpy.savez");
    }
    if (size == kInZip64 || local == kInZip64) refuse("is larger than 4 GB", ErrorCode::kUnsupported);
    if (number(entry + 20, 4) != size || number(local, 4) != kLocalFile) {
      refuse(fmt::format("'{}' in it is damaged", path));
    }
    const std::string content = text(local + kLocalSize + number(local + 26, 2) + number(local + 28, 2), size);
    if (checksum(content) != number(entry + 16, 4)) refuse(fmt::format("'{}' in it is damaged", path));
    return Bytes(content.begin(), content.end());
  }

  // CRC-32, the polynomial reversed.
  static std::uint32_t checksum(std::string_view content) {
    std::uint32_t sum = ~std::uint32_t{0};
    for (const char c : content) {
      sum ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (sum % 2 == 1 ? 0xedb88320u : 0);
    }
    return ~sum;
  }

  ByteSpan bytes_;
  std::string_view name_;
};

}  // namespace

std::map<std::string, Bytes> readStoredArchive(ByteSpan bytes, std::string_view name) {
  return StoredArchive(bytes, name).files();
}

}  // namespace limber
