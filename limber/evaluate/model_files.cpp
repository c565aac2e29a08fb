#include "limber/evaluate/model_files.h"

#include <algorithm>

#include "limber/core/error.h"

namespace limber {

std::vector<std::filesystem::path> modelsBelow(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string extension = it->path().extension().string();
    if (extension == ".glb" || extension == ".gltf") files.push_back(it->path());
  }
  if (error) throw Error(ErrorCode::kFile, error.message(), folder.string());
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.stem() < b.stem(); });
  return files;
}

std::string lastName(const std::filesystem::path& folder) {
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

}  // namespace limber
