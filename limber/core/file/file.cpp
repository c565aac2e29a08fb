#include "limber/core/file/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/file/storage_error.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

constexpr std::size_t kChunk = std::size_t{1} << 20;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int reason) {
  throw Error(ErrorCode::kFile, what + ": " + std::strerror(reason), path.string());
}

void readStream(std::FILE* stream, const fs::path& path, const std::function<void(ByteSpan)>& take) {
  Bytes piece(kChunk);
  std::size_t got = 0;
  do {
    got = std::fread(piece.data(), 1, piece.size(), stream);
    if (got > 0) take({piece.data(), got});
  } while (got == piece.size());
  if (std::ferror(stream)) fail(path, "cannot be read", errno);
}

// Errors name `path`.
void writeStream(std::FILE* stream, const OutputFile& file, const fs::path& path) {
  const auto write = [&](ByteSpan bytes) {
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), stream) != bytes.size()) {
      failToWrite(path, errno);
    }
  };
  write(file.bytes);
  for (const ByteSpan piece : file.further) write(piece);
  if (std::fflush(stream) != 0) failToWrite(path, errno);
}

void closeStream(File stream, const fs::path& path) {
  if (std::fclose(stream.release()) != 0) failToWrite(path, errno);
}

// What a link points to, also where nothing is there yet: the link stays, the file behind it is replaced.
fs::path behindLinks(fs::path path) {
  constexpr int kMaxLinks = 40;
  std::error_code problem;
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, problem)); ++links) {
    if (links == kMaxLinks) failToWrite(path, ELOOP);
    path = path.parent_path() / fs::read_symlink(path, problem);
    if (problem) failToWrite(path, problem.value());
  }
  return path;
}

// Is there a device, a pipe or the like, which must not be replaced by a file?
bool isNoPlainFile(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw Error(ErrorCode::kFile, "is a folder, not a file", path.string());
  return fs::exists(status) && !fs::is_regular_file(status);
}

void writeStraight(const OutputFile& file) {
  if (file.path == "-") return writeStream(stdout, file, "standard output");
  File stream(std::fopen(file.path.string().c_str(), "wb"));
  if (!stream) failToWrite(file.path, errno);
  writeStream(stream.get(), file, file.path);
  closeStream(std::move(stream), file.path);
}

// A file under a temporary name beside its final path; gone with this object unless published.
class PendingFile {
 public:
  explicit PendingFile(fs::path location) : path_(std::move(location)) {}
  PendingFile(PendingFile&& other) noexcept
      : path_(std::move(other.path_)), temporary_(std::move(other.temporary_)), made_(other.made_) {
    other.made_ = false;
  }
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile() {
    std::error_code ignored;
    if (made_) fs::remove(temporary_, ignored);
  }

  void write(const OutputFile& file) {
    File stream = openBeside();
    writeStream(stream.get(), file, path_);
    closeStream(std::move(stream), path_);
  }

  void publish() {
    std::error_code problem;
    fs::rename(temporary_, path_, problem);
    if (problem) failToWrite(path_, problem.value());
    made_ = false;
  }

 private:
  // Opens the file under the first unused name: another run may be writing to the same path.
  File openBeside() {
    constexpr int kMaxNames = 1000;
    for (int i = 0; i < kMaxNames; ++i) {
      temporary_ = path_;
      temporary_ += ".limber-part" + (i == 0 ? std::string() : std::to_string(i));
      File stream(std::fopen(temporary_.string().c_str(), "wbx"));
      made_ = stream != nullptr;
      if (made_) return stream;
      if (errno != EEXIST) break;
    }
    failToWrite(path_, errno);
  }

  fs::path path_, temporary_;
  bool made_ = false;
};

}  // namespace

void readFileInPieces(const fs::path& path, const std::function<void(ByteSpan)>& take) {
  if (path == "-") return readStream(stdin, "standard input", take);
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw Error(ErrorCode::kFile, "is a folder, not a file", path.string());
  const File stream(std::fopen(path.string().c_str(), "rb"));
  if (!stream) fail(path, "cannot be opened", errno);
  readStream(stream.get(), path, take);
}

Bytes readFile(const fs::path& path) {
  Bytes bytes;
  readFileInPieces(path, [&](ByteSpan piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  return bytes;
}

void writeFiles(std::span<const OutputFile> files) {
  std::vector<PendingFile> pending;
  std::vector<const OutputFile*> straight;
  for (const OutputFile& file : files) {
    if (file.path == "-" || isNoPlainFile(file.path)) {
      straight.push_back(&file);
    } else {
      pending.emplace_back(behindLinks(file.path)).write(file);
    }
  }
  for (const OutputFile* file : straight) writeStraight(*file);
  for (PendingFile& file : pending) file.publish();
}

void writeFile(const fs::path& path, ByteSpan bytes) {
  const OutputFile file{path, bytes};
  writeFiles({&file, 1});
}

}  // namespace limber
