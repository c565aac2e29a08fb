// What a model's or a motion's file holds, as one number.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace limber {

struct InputDigest {
  std::string bytes;  // SHA-256 of the file alone
  // Of the file's bytes and its extension, and of those files in its folder and in folders below it that its bytes name
  // (a .gltf's "buffers/a.bin", an .obj's .mtl and the pictures that this names, an .fbx's "textures\a.png"). Files in
  // other folders or more than eight folders below, and names without an extension, do not count.
  std::string all;
};

// Digests of many files. What a folder holds is looked up once, of folders below only where they are named. Throws
// Error kFile, also for what is no plain file (a pipe or a device may never end) and for a file of more than
// `mostBytes`.
class InputDigests {
 public:
  explicit InputDigests(std::uintmax_t maxBytes = std::numeric_limits<std::uintmax_t>::max()) : most_(maxBytes) {}

  InputDigest of(const std::filesystem::path& file);

 private:
  // Names as they stand in other files: as they are, and percent-encoded.
  struct Names {
    std::map<std::string, std::string, std::less<>> names;  // by how they are written
    std::set<std::size_t> lengths;                          // of how they are written

    void add(const std::string& name);
  };
  struct FolderNames {
    Names files, folders;
    std::set<std::string, std::less<>> extensions;  // of the files
  };
  using Paths = std::set<std::string>;  // seen from a folder, '/' between their parts

  void check(const std::filesystem::path& file) const;  // throws where it is not to be read
  std::string digestOf(const std::filesystem::path& file) const;
  const FolderNames& namesIn(const std::filesystem::path& folder);
  void findFiles(std::string_view text, const FolderNames& names, Paths& found) const;
  void findBelow(std::string_view text, const std::filesystem::path& folder, Paths& found);
  void findFrom(std::string_view text, const std::filesystem::path& folder, const std::string& path, int deeper,
                Paths& found);
  Paths namedBeside(const std::filesystem::path& file);

  std::uintmax_t most_;
  std::map<std::string, FolderNames> folders_;
};

}  // namespace limber
