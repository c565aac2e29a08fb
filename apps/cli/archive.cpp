#include "archive.h"

#include <zip.h>

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber::cli {

namespace {

constexpr zip_int64_t kMostFiles = 1000;
constexpr zip_uint64_t kMostBytes = 2'000'000'000;  // of all files together, unpacked
constexpr zip_uint64_t kMostRatio = 1100;           // bytes for each packed one: deflate makes no more than 1032

bool leadsOut(const std::string& path) {
  const std::filesystem::path plain = path;
  if (path.empty() || plain.is_absolute() || path.find('\\') != std::string::npos || path.find('\0') != path.npos)
    return true;
  for (const std::filesystem::path& step : plain) {
    if (step == "..") return true;
  }
  return false;
}

}  // namespace

bool isArchive(ByteSpan bytes) {
  return bytes.size() >= 4 && bytes[0] == 'P' && bytes[1] == 'K' && bytes[2] == 3 && bytes[3] == 4;
}

std::map<std::string, Bytes> readArchive(ByteSpan bytes, const std::string& name) {
  const auto refuse = [&](const std::string& what) { throw Error(ErrorCode::kBadData, what, name); };
  zip_error_t trouble;
  zip_error_init(&trouble);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &trouble);
  zip_t* opened = source ? zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &trouble) : nullptr;
  if (!opened) {
    const std::string what = fmt::format("is no whole ZIP archive: {}", zip_error_strerror(&trouble));
    zip_error_fini(&trouble);
    if (source) zip_source_free(source);
    refuse(what);
  }
  const std::unique_ptr<zip_t, decltype(&zip_discard)> archive(opened, zip_discard);
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  if (count > kMostFiles) refuse(fmt::format("holds {} files, more than {}", count, kMostFiles));

  std::map<std::string, Bytes> files;
  zip_uint64_t all = 0;
  for (zip_int64_t i = 0; i < count; ++i) {
    const auto number = static_cast<zip_uint64_t>(i);
    zip_stat_t entry;
    constexpr zip_uint64_t kKnown = ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE;
    if (zip_stat_index(archive.get(), number, 0, &entry) != 0 || (entry.valid & kKnown) != kKnown)
      refuse(fmt::format("file {} in it has no name or size", i));
    const std::string path = entry.name;
    if (path.ends_with('/')) continue;
    if (leadsOut(path)) refuse(fmt::format("'{}' leads out of the archive", path));
    if (entry.size > kMostRatio * (entry.comp_size + 1)) refuse(fmt::format("'{}' is packed beyond belief", path));
    all += entry.size;
    if (entry.size > kMostBytes || all > kMostBytes) refuse("holds more than 2 GB");
    const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(zip_fopen_index(archive.get(), number, 0),
                                                                  zip_fclose);
    Bytes content(entry.size);
    const bool read = file && zip_fread(file.get(), content.data(), entry.size) == static_cast<zip_int64_t>(entry.size);
    // Reading on to the end checks the sum.
    std::uint8_t more = 0;
    if (!read || zip_fread(file.get(), &more, 1) != 0) refuse(fmt::format("'{}' in it is damaged", path));
    if (!files.emplace(path, std::move(content)).second) refuse(fmt::format("holds '{}' twice", path));
  }
  return files;
}

}  // namespace limber::cli
