// What a folder holds. The door to the file system for those who look for files, as file.h is for their bytes.
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

}  // namespace limber
