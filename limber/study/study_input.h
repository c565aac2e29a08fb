// The files that the names in a plan stand for.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace limber {

enum class InputKind { kModel, kMotion };

struct StudyInput {
  std::filesystem::path file;  // absolute
  std::string name;            // short and unlike all others of the list
  std::string group;           // its folder's name
  std::string sample;          // that the file is to be made of; empty: it is there
};

// The files of a folder, at any depth, that limber reads as such, by their paths in order. Throws Error kFile.
std::vector<std::filesystem::path> inputFilesBelow(const std::filesystem::path& folder, InputKind kind);

// In the order of the names, those of a folder by their paths. `folder` is what relative paths are seen from; samples
// are to be made in `samples`. Throws Error kFile: a name that is no file or folder, a folder without such files.
std::vector<StudyInput> findInputs(std::span<const std::string> names, InputKind kind,
                                   const std::filesystem::path& folder, const std::filesystem::path& samples);

}  // namespace limber
