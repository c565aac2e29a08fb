#include "limber/jobs/result_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/file/file.h"
#include "limber/core/file/folder.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kExtension = ".json";

void removeLeftovers(const fs::path& folder) {
  std::vector<fs::path> leftovers;
  std::error_code problem;
  for (fs::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    if (it->path().filename().string().find(".limber-part") != std::string::npos) leftovers.push_back(it->path());
  }
  for (const fs::path& file : leftovers) fs::remove(file, problem);
}

}  // namespace

ResultStore::ResultStore(fs::path folder) : folder_(std::move(folder)) {
  makeFolder(folder_);
  lock_ = open((folder_ / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock_ < 0)
    throw Error(ErrorCode::kFile, std::string("cannot be written: ") + std::strerror(errno), folder_.string());
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(lock_);
    throw Error(ErrorCode::kFile, "another program is writing there", folder_.string(), "wait for it, or end it");
  }
  removeLeftovers(folder_);
}

ResultStore::~ResultStore() {
  close(lock_);
}

fs::path ResultStore::pathOf(const std::string& key) const {
  return folder_ / (key + std::string(kExtension));
}

std::optional<std::string> ResultStore::find(const std::string& key) const {
  std::error_code unseen;
  if (!fs::is_regular_file(pathOf(key), unseen)) return std::nullopt;
  const Bytes bytes = readFile(pathOf(key));
  return std::string(bytes.begin(), bytes.end());
}

void ResultStore::keep(const std::string& key, std::string_view text) {
  writeFile(pathOf(key), asBytes(text));
}

}  // namespace limber
