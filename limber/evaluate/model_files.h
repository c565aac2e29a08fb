// The models of a folder that an evaluation runs over.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limber {

// Every .glb and .gltf below `folder`, ordered by name without folders, and by the whole path where
// names are alike. Throws Error kFile where the folder cannot be read.
std::vector<std::filesystem::path> modelsBelow(const std::filesystem::path& folder);

// The last name of a folder's path, however it ends: "tune" of "creatures/tune/".
std::string lastName(const std::filesystem::path& folder);

}  // namespace limber
