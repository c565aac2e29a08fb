// The name of a job's result: equal for equal inputs, arguments and programs, wherever their files lie.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "limber/jobs/sha256.h"

namespace limber {

// A digest of pieces in order; where one ends and the next begins counts.
class JobKey {
 public:
  JobKey& add(std::string_view piece);
  // The piece's 64 hexadecimal digits; nothing may be added after.
  std::string hex() { return hash_.hex(); }

 private:
  Sha256 hash_;
};

// A digest of a file's bytes and its extension, and of those files in its folder that its bytes name (a .gltf's .bin,
// an .obj's .mtl and the pictures that this names). Files in other folders that it refers to do not count. Throws Error
// kFile.
std::string inputDigest(const std::filesystem::path& file);

}  // namespace limber
