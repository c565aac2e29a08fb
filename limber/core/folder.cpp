#include "limber/core/folder.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "limber/core/error.h"
#include "limber/core/names.h"

namespace limber {

std::vector<std::filesystem::path> filesBelow(const std::filesystem::path& folder,
                                              std::initializer_list<std::string_view> extensions) {
  std::vector<std::filesystem::path> files;
  std::error_code problem;
  for (std::filesystem::recursive_directory_iterator it(folder, problem), end; !problem && it != end;
       it.increment(problem)) {
    const std::string extension = lowerExtension(it->path());
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) continue;
    std::error_code ignored;
    if (!it->is_directory(ignored)) files.push_back(it->path());
  }
  if (problem) throw Error(ErrorCode::kFile, "cannot be read: " + problem.message(), folder.string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace limber
