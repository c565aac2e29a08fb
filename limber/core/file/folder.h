// Folders, and what they hold. The door to the file system for those who look for files, as file.h is for their bytes.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace limber {

// The files below `folder`, at any depth, whose names end in one of these (".glb", as lowerExtension has them: upper
// and lower case alike), by their paths in order. Links to folders are not entered. Throws Error kFile where a folder
// cannot be read.
std::vector<std::filesystem::path> filesBelow(const std::filesystem::path& folder,
                                              std::initializer_list<std::string_view> extensions);

// All files below it, likewise.
std::vector<std::filesystem::path> filesBelow(const std::filesystem::path& folder);

// Makes the folder, and those that it lies in, where they are not there. Throws Error kFile.
void makeFolder(const std::filesystem::path& folder);

// Takes it away with all that is in it, where it is there. Throws Error kFile.
void removeFolder(const std::filesystem::path& folder);

}  // namespace limber
