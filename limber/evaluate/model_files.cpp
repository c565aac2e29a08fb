#include "limber/evaluate/model_files.h"

#include <algorithm>

#include "limber/core/file/folder.h"

namespace limber {

std::vector<std::filesystem::path> modelsBelow(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files = filesBelow(folder, {".glb", ".gltf"});
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    const int order = a.stem().compare(b.stem());
    return order != 0 ? order < 0 : a < b;
  });
  return files;
}

std::string lastName(const std::filesystem::path& folder) {
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

void forEachFile(std::size_t count, std::string_view stage, const SkippedFiles& unread, Progress& progress,
                 Warnings& skipped, const std::function<void(std::size_t)>& each) {
  progress.stage(stage);
  for (std::size_t i = 0; i < count; ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(count));
    try {
      each(i);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      skipped.add(unread.kind, unread.message, error.what());
    }
  }
  progress.finish();
}

}  // namespace limber
