#include "limber/document/stored_archive.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "limber/core/file/inflate.h"
#include "limber/core/file/read_bounds.h"

namespace limber {

namespace {

// Signatures and sizes in bytes of the records that APPNOTE.TXT 6.3 (PKWARE) lays down.
constexpr std::uint32_t kLocalFile = 0x04034b50, kDirectoryEntry = 0x02014b50, kDirectoryEnd = 0x06054b50;
constexpr std::size_t kLocalSize = 30, kEntrySize = 46, kEndSize = 22, kMaxComment = 65535;
constexpr std::uint32_t kStored = 0, kDeflated = 8;    // compression methods
constexpr std::uint64_t kMaxUnpacked = 2'000'000'000;  // of files together
constexpr std::uint32_t kInZip64 = 0xffffffff;         // marks a number that is stored elsewhere

// CRC-32, the polynomial reversed, a byte at a time by a table.
class Checksum {
 public:
  constexpr Checksum() {
    for (std::uint32_t byte = 0; byte < table_.size(); ++byte) {
      std::uint32_t sum = byte;
      for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (sum % 2 == 1 ? 0xedb88320u : 0);
      table_[byte] = sum;
    }
  }
  std::uint32_t of(ByteSpan bytes) const {
    std::uint32_t sum = ~std::uint32_t{0};
    for (const std::uint8_t byte : bytes) sum = table_[(sum ^ byte) & 0xff] ^ (sum >> 8);
    return ~sum;
  }

 private:
  std::array<std::uint32_t, 256> table_ = {};
};
constexpr Checksum kChecksum;

// Writes the records of an archive.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(std::size_t alignment) : alignment_(alignment) {}

  void add(const StoredFile& file) {
    const std::size_t at = bytes_.size();
    const std::size_t padding = paddingFor(at + kLocalSize + file.path.size());
    put(bytes_, kLocalFile, 4);
    putCommon(bytes_, file, padding);
    put(bytes_, file.path);
    if (padding > 0) {
      put(bytes_, kPaddingField, 2);
      put(bytes_, padding - kFieldHeader, 2);
      bytes_.resize(bytes_.size() + padding - kFieldHeader);
    }
    bytes_.insert(bytes_.end(), file.bytes.begin(), file.bytes.end());

    put(directory_, kDirectoryEntry, 4);
    put(directory_, kVersion, 2);
    putCommon(directory_, file, 0);
    for (const int size : {2, 2, 2, 4}) put(directory_, 0, size);  // no comment, first disk, no attributes
    put(directory_, at, 4);
    put(directory_, file.path);
    ++files_;
    constexpr std::size_t kMaxFiles = 65535;
    if (bytes_.size() + directory_.size() >= kInZip64 - kEndSize || files_ > kMaxFiles) {
      throw Error(ErrorCode::kLimit, "is larger than a ZIP archive can be", file.path);
    }
  }

  Bytes finish() {
    const std::size_t start = bytes_.size();
    bytes_.insert(bytes_.end(), directory_.begin(), directory_.end());
    put(bytes_, kDirectoryEnd, 4);
    put(bytes_, 0, 4);
    for (int i = 0; i < 2; ++i) put(bytes_, files_, 2);
    put(bytes_, directory_.size(), 4);
    put(bytes_, start, 4);
    put(bytes_, 0, 2);
    return std::move(bytes_);
  }

 private:
  static constexpr std::uint32_t kVersion = 20, kFirstDay = 33;  // of 1980, the earliest that there is
  static constexpr std::uint32_t kPaddingField = 0x1986;         // as USD's own tools call it
  static constexpr std::size_t kFieldHeader = 4;

  static void put(Bytes& bytes, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  static void put(Bytes& bytes, const std::string& text) { bytes.insert(bytes.end(), text.begin(), text.end()); }

  // What both records of a file have in common, from the version that reading needs to the length of further fields.
  static void putCommon(Bytes& bytes, const StoredFile& file, std::size_t further) {
    put(bytes, kVersion, 2);
    for (int i = 0; i < 3; ++i) put(bytes, 0, 2);  // no flags, stored, midnight
    put(bytes, kFirstDay, 2);
    put(bytes, kChecksum.of(file.bytes), 4);
    for (int i = 0; i < 2; ++i) put(bytes, file.bytes.size(), 4);
    put(bytes, file.path.size(), 2);
    put(bytes, further, 2);
  }

  // A further field is at least its own header.
  std::size_t paddingFor(std::size_t begin) const {
    std::size_t padding = (alignment_ - begin % alignment_) % alignment_;
    while (padding > 0 && padding < kFieldHeader) padding += alignment_;
    return padding;
  }

  std::size_t alignment_, files_ = 0;
  Bytes bytes_, directory_;
};

}  // namespace

bool looksLikeZipArchive(ByteSpan bytes) {
  constexpr std::array<std::uint8_t, 4> kBegin = {'P', 'K', 3, 4};
  return bytes.size() >= kBegin.size() && std::equal(kBegin.begin(), kBegin.end(), bytes.begin());
}

ZipArchive::ZipArchive(ByteSpan bytes, std::string_view name) : bytes_(bytes), name_(name) {
  const std::size_t end = directoryEnd();
  const std::uint64_t count = number(end + 10, 2);
  std::size_t at = number(end + 16, 4);
  std::size_t packed = 0;  // entries that share their bytes would make memory grow beyond the archive
  for (std::uint64_t i = 0; i < count; ++i) {
    if (number(at, 4) != kDirectoryEntry) refuse("its directory is damaged");
    const std::size_t nameSize = number(at + 28, 2);
    const std::string path = text(at + kEntrySize, nameSize);
    packed += number(at + 20, 4);
    if (packed > bytes_.size()) refuse("files in it share their bytes");
    if (!entries_.emplace(path, Entry{at, number(at + 24, 4)}).second) refuse(fmt::format("holds '{}' twice", path));
    at += kEntrySize + nameSize + number(at + 30, 2) + number(at + 32, 2);
  }
}

std::optional<Bytes> ZipArchive::find(const std::string& path) const {
  const auto entry = entries_.find(path);
  if (entry == entries_.end()) return std::nullopt;
  checkSize(entry->second.unpacked);
  return contentOf(entry->second.at, path);
}

std::map<std::string, Bytes> ZipArchive::files(const Asked& isAskedFor) const {
  std::map<std::string, Bytes> files;
  std::uint64_t unpacked = 0;
  for (const auto& [path, entry] : entries_) {
    if (isAskedFor && !isAskedFor(path)) continue;
    checkSize(unpacked += entry.unpacked);
    files.emplace(path, contentOf(entry.at, path));
  }
  return files;
}

std::size_t ZipArchive::maxUnpacked() const {
  return static_cast<std::size_t>(std::min(kMaxUnpacked, read_bounds::kArchive.of(bytes_.size())));
}

void ZipArchive::checkSize(std::uint64_t unpacked) const {
  if (unpacked <= maxUnpacked()) return;
  refuse(fmt::format("holds more than {} MB, which so small an archive does not explain", maxUnpacked() >> 20),
         ErrorCode::kLimit);
}

void ZipArchive::refuse(std::string what, ErrorCode code, std::string remedy) const {
  throw Error(code, std::move(what), name_, std::move(remedy));
}

std::uint32_t ZipArchive::number(std::size_t at, std::size_t size) const {
  if (at > bytes_.size() || size > bytes_.size() - at) refuse("is cut off, or no ZIP archive");
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t{bytes_[at + i]} << (8 * i);
  return value;
}

std::string ZipArchive::text(std::size_t at, std::size_t size) const {
  if (at > bytes_.size() || size > bytes_.size() - at) refuse("is cut off, or no ZIP archive");
  return {reinterpret_cast<const char*>(bytes_.data()) + at, size};
}

// Behind it is a comment of any length, whose length it tells.
std::size_t ZipArchive::directoryEnd() const {
  for (std::size_t back = kEndSize; back <= bytes_.size() && back <= kEndSize + kMaxComment; ++back) {
    const std::size_t at = bytes_.size() - back;
    if (number(at, 4) == kDirectoryEnd && number(at + 20, 2) == back - kEndSize) return at;
  }
  refuse("is cut off, or no ZIP archive");
}

Bytes ZipArchive::contentOf(std::size_t entry, const std::string& path) const {
  if (number(entry + 8, 2) % 2 == 1) refuse(fmt::format("'{}' in it is encrypted", path), ErrorCode::kUnsupported);
  const std::uint32_t packed = number(entry + 20, 4), size = number(entry + 24, 4), local = number(entry + 42, 4);
  const std::uint32_t method = number(entry + 10, 2);
  if (method != kStored && method != kDeflated) {
    refuse(fmt::format("'{}' in it is compressed in another way than by deflate", path), ErrorCode::kUnsupported);
  }
  if (packed == kInZip64 || size == kInZip64 || local == kInZip64) {
    refuse("is larger than 4 GB", ErrorCode::kUnsupported);
  }
  const auto damaged = [&] { refuse(fmt::format("'{}' in it is damaged", path)); };
  if (number(local, 4) != kLocalFile) damaged();
  const std::size_t begin = std::size_t{local} + kLocalSize + number(local + 26, 2) + number(local + 28, 2);
  if (begin > bytes_.size() || packed > bytes_.size() - begin) refuse("is cut off, or no ZIP archive");
  const ByteSpan data = bytes_.subspan(begin, packed);
  if (method == kStored ? size != data.size() : size / kMaxInflatedPerByte > data.size()) damaged();
  Bytes content(size);
  if (method == kStored) {
    std::copy(data.begin(), data.end(), content.begin());
  } else {
    try {
      inflate(data, content);
    } catch (const Error&) {
      damaged();
    }
  }
  if (kChecksum.of(content) != number(entry + 16, 4)) damaged();
  return content;
}

std::map<std::string, Bytes> readZipArchive(ByteSpan bytes, std::string_view name,
                                            const ZipArchive::Asked& isAskedFor) {
  return ZipArchive(bytes, name).files(isAskedFor);
}

Bytes writeStoredArchive(std::span<const StoredFile> files, std::size_t alignment) {
  ArchiveWriter writer(alignment);
  for (const StoredFile& file : files) writer.add(file);
  return writer.finish();
}

}  // namespace limber
