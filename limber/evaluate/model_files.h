// The models of a folder that an evaluation runs over.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"

namespace limber {

// Every .glb and .gltf below `folder`, ordered by name without folders, and by the whole path where
// names are alike. Throws Error kFile where the folder cannot be read.
std::vector<std::filesystem::path> modelsBelow(const std::filesystem::path& folder);

// The last name of a folder's path, however it ends: "tune" of "creatures/tune/".
std::string lastName(const std::filesystem::path& folder);

// How a warning calls the files that an evaluation leaves out.
struct SkippedFiles {
  std::string_view kind, message;
};
inline constexpr SkippedFiles kNotCompared = {"unreadable", "files that cannot be compared left out"};
inline constexpr SkippedFiles kUnreadMotions = {"unreadable-motions", "motions that cannot be read left out"};

// Calls each(0) to each(count - 1) as one stage. What throws an Error is counted in `skipped` and the next one follows;
// kCancelled is thrown on.
void forEachFile(std::size_t count, std::string_view stage, const SkippedFiles& unread, Progress& progress,
                 Warnings& skipped, const std::function<void(std::size_t)>& each);

}  // namespace limber
