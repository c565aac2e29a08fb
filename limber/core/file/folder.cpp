#include "limber/core/file/folder.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "limber/core/error.h"
#include "limber/core/file/storage_error.h"
#include "limber/core/text/names.h"

namespace limber {

namespace {

// A folder that is gone by the time it is looked into holds nothing: others may be at work there.
void addFilesBelow(const std::filesystem::path& folder, std::vector<std::filesystem::path>& files,
                   std::error_code& problem) {
  for (std::filesystem::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem)) {
    std::error_code ignored;
    if (!it->is_directory(ignored)) {
      files.push_back(it->path());
    } else if (!it->is_symlink(ignored)) {
      addFilesBelow(it->path(), files, problem);
      if (problem == std::errc::no_such_file_or_directory) problem.clear();
      if (problem) return;
    }
  }
}

}  // namespace

std::vector<std::filesystem::path> filesBelow(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code problem;
  addFilesBelow(folder, files, problem);
  if (problem) throw Error(ErrorCode::kFile, "cannot be read: " + problem.message(), folder.string());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::filesystem::path> filesBelow(const std::filesystem::path& folder,
                                              std::initializer_list<std::string_view> extensions) {
  std::vector<std::filesystem::path> files = filesBelow(folder);
  std::erase_if(files, [&](const std::filesystem::path& file) {
    return std::find(extensions.begin(), extensions.end(), lowerExtension(file)) == extensions.end();
  });
  return files;
}

void makeFolder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) failToWrite(folder, problem.value(), "cannot be made");
}

void removeFolder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::remove_all(folder, problem);
  if (problem) throw Error(ErrorCode::kFile, "cannot be removed: " + problem.message(), folder.string());
}

}  // namespace limber
