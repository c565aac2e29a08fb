#include "limber/study/study_input.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <system_error>

#include "limber/core/error.h"
#include "limber/core/file/folder.h"
#include "limber/document/utf8.h"
#include "limber/study/study_plan.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kSampleGroup = "samples";

void addFile(const fs::path& file, std::vector<StudyInput>& inputs) {
  const bool isKnown = std::any_of(inputs.begin(), inputs.end(), [&](const StudyInput& i) { return i.file == file; });
  if (isKnown) return;
  inputs.push_back({file, {}, validUtf8(file.parent_path().filename().string()), {}});
}

// The last `parts` of a path; of one, without its extension.
std::string lastParts(const fs::path& file, std::size_t parts) {
  if (parts == 0) return validUtf8(file.stem().string());
  fs::path name = file.filename(), folder = file.parent_path();
  for (std::size_t i = 1; i < parts && folder.has_filename(); ++i, folder = folder.parent_path()) {
    name = folder.filename() / name;
  }
  return validUtf8(name.generic_string());
}

// As short as tells each from all others.
void nameInputs(std::vector<StudyInput>& inputs) {
  constexpr std::size_t kMaxParts = 64;
  for (std::size_t parts = 0; parts < kMaxParts; ++parts) {
    std::map<std::string, int> taken;
    for (StudyInput& input : inputs) {
      if (parts == 0 || input.name.empty()) input.name = lastParts(input.file, parts);
      ++taken[input.name];
    }
    bool isUnique = true;
    for (StudyInput& input : inputs) {
      if (taken[input.name] == 1) continue;
      input.name.clear();
      isUnique = false;
    }
    if (isUnique) return;
  }
  for (StudyInput& input : inputs) {
    if (input.name.empty()) input.name = validUtf8(input.file.string());
  }
}

}  // namespace

std::vector<fs::path> inputFilesBelow(const fs::path& folder, InputKind kind) {
  if (kind == InputKind::kMotion) return filesBelow(folder, {".bvh", ".npz", ".glb", ".gltf", ".fbx", ".dae"});
  return filesBelow(folder, {".glb", ".gltf", ".obj", ".ply", ".stl", ".off", ".fbx", ".dae"});
}

std::vector<StudyInput> findInputs(std::span<const std::string> names, InputKind kind, const fs::path& folder,
                                   const fs::path& samples) {
  std::vector<StudyInput> inputs;
  for (const std::string& name : names) {
    if (name.starts_with(kSamplePrefix)) {
      const std::string sample = name.substr(kSamplePrefix.size());
      if (sample.find_first_of("/\\") != std::string::npos || sample.starts_with("-")) {
        throw Error(ErrorCode::kBadArgument, "is no sample's name", name, "limber sample lists them");
      }
      const char* extension = kind == InputKind::kMotion ? ".bvh" : ".glb";
      inputs.push_back(
          {fs::absolute(samples / (sample + extension)).lexically_normal(), {}, std::string(kSampleGroup), sample});
      continue;
    }
    const fs::path location = fs::absolute(folder / name).lexically_normal();
    std::error_code unseen;
    if (fs::is_directory(location, unseen)) {
      const std::vector<fs::path> files = inputFilesBelow(location, kind);
      if (files.empty()) throw Error(ErrorCode::kFile, "holds nothing that can be read", location.string());
      for (const fs::path& file : files) addFile(file, inputs);
    } else if (fs::exists(location, unseen)) {
      addFile(location, inputs);
    } else {
      throw Error(ErrorCode::kFile, "is not there", location.string(),
                  "paths in a plan are seen from the plan's folder");
    }
  }
  nameInputs(inputs);
  return inputs;
}

}  // namespace limber
