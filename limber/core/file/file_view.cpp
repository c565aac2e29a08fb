#include "limber/core/file/file_view.h"

#if (defined(__unix__) || defined(__APPLE__)) && !defined(__EMSCRIPTEN__)
#define LIMBER_MAPS_FILES
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace limber {

namespace fs = std::filesystem;

#ifdef LIMBER_MAPS_FILES

class FileView::Mapping {
 public:
  // Null where there is no plain file of that size, or the system refuses.
  static std::unique_ptr<Mapping> of(const fs::path& path, std::size_t atLeast) {
    // Looked at before it is opened: whoever writes into a pipe would take that for its reader.
    struct stat status;
    const auto isRight = [&](int found) {
      return found == 0 && S_ISREG(status.st_mode) && status.st_size > 0 &&
             static_cast<std::size_t>(status.st_size) >= atLeast;
    };
    if (!isRight(stat(path.c_str(), &status))) return nullptr;
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return nullptr;
    std::unique_ptr<Mapping> mapping;
    if (isRight(fstat(file, &status))) {
      const auto size = static_cast<std::size_t>(status.st_size);
      void* begin = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
      if (begin != MAP_FAILED) mapping.reset(new Mapping(begin, size));
    }
    close(file);
    return mapping;
  }

  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() { munmap(begin_, size_); }

  ByteSpan bytes() const { return {static_cast<const std::uint8_t*>(begin_), size_}; }

 private:
  Mapping(void* begin, std::size_t size) : begin_(begin), size_(size) {}

  void* begin_;
  std::size_t size_;
};

#else

class FileView::Mapping {
 public:
  static std::unique_ptr<Mapping> of(const fs::path&, std::size_t) { return nullptr; }
  ByteSpan bytes() const { return {}; }
};

#endif

FileView::FileView(const fs::path& path, std::size_t mapFrom) {
  if (path != "-") mapping_ = Mapping::of(path, mapFrom);
  if (!mapping_) read_ = readFile(path);
  bytes_ = mapping_ ? mapping_->bytes() : ByteSpan(read_);
}

FileView::~FileView() = default;

}  // namespace limber
