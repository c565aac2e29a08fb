// Where tests find the shared models, and where they leave the files that the glTF validator is to look at.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "limber/core/text/names.h"
#include "source_folder.h"

namespace limber::testing {

// The folder of shared models: LIMBER_SHARED_DATA, else ../shared/data beside the checkout; none where there is no such
// folder, and tests that want it skip with kNoSharedData.
inline std::optional<std::filesystem::path> sharedDataFolder() {
  const char* named = std::getenv("LIMBER_SHARED_DATA");
  const std::filesystem::path folder =
      named && *named ? std::filesystem::path(named) : sourceFolder() / "../shared/data";
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return std::nullopt;
  return std::filesystem::canonical(folder);
}

inline constexpr std::string_view kNoSharedData =
    "the shared models are not there (looked in ../shared/data and LIMBER_SHARED_DATA)";

// Is that a model that limber reads as a mesh, by its extension?
inline bool isModelFile(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 8> kExtensions = {".glb", ".gltf", ".obj", ".ply",
                                                                  ".stl", ".off",  ".fbx", ".dae"};
  const std::string extension = lowerExtension(path);
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

// Every model below `folder`, in order of its path.
inline std::vector<std::filesystem::path> modelFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->is_regular_file() && isModelFile(it->path())) files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}

// The folder for glTF files that a test writes: LIMBER_TEST_OUTPUT, else one below the system's temporary folder.
inline std::filesystem::path testOutputFolder() {
  const char* named = std::getenv("LIMBER_TEST_OUTPUT");
  const std::filesystem::path folder =
      named && *named ? std::filesystem::path(named) : std::filesystem::temp_directory_path() / "limber_test_output";
  std::filesystem::create_directories(folder);
  return folder;
}

// Notes which input a written file came from, so that the validator stage (tools/validate.mjs) can tell the warnings
// that the input had before from new ones.
inline void noteSource(const std::filesystem::path& output, const std::filesystem::path& source) {
  std::ofstream note(output.string() + ".source");
  note << source.string() << '\n';
}

}  // namespace limber::testing
