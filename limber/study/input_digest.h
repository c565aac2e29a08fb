// What a model's or a motion's file holds, as one number.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace limber {

struct InputDigest {
  std::string bytes;  // SHA-256 of the file alone
  // Of the file's bytes and its extension, and of those files in its folder that its bytes name (a .gltf's .bin, an
  // .obj's .mtl and the pictures that this names). Files in other folders, and names without an extension, do not
  // count.
  std::string all;
};

// Digests of many files. What a folder holds is looked up once. Throws Error kFile, also for what is no plain file (a
// pipe or a device may never end) and for a file of more than `mostBytes`.
class InputDigests {
 public:
  explicit InputDigests(std::uintmax_t mostBytes = std::numeric_limits<std::uintmax_t>::max()) : most_(mostBytes) {}

  InputDigest of(const std::filesystem::path& file);

 private:
  // Names of a folder's files as they stand in other files: as they are, and percent-encoded.
  struct FolderNames {
    std::map<std::string, std::string, std::less<>> files;  // by how they are written
    std::set<std::size_t> lengths;
    std::set<std::string, std::less<>> extensions;
  };

  void check(const std::filesystem::path& file) const;  // throws where it is not to be read
  std::string digestOf(const std::filesystem::path& file) const;
  const FolderNames& namesIn(const std::filesystem::path& folder);
  std::set<std::string> namedBeside(const std::filesystem::path& file);

  std::uintmax_t most_;
  std::map<std::string, FolderNames> folders_;
};

}  // namespace limber
