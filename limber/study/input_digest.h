// What a model's or a motion's file holds, as one number.
#pragma once

#include <filesystem>
#include <string>

namespace limber {

// A digest of a file's bytes and its extension, and of those files in its folder that its bytes name (a .gltf's .bin,
// an .obj's .mtl and the pictures that this names). Files in other folders that it refers to do not count. Throws Error
// kFile.
std::string inputDigest(const std::filesystem::path& file);

}  // namespace limber
