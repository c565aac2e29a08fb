#include "limber/document/gltf/gltf_files.h"

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/gltf_json.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/uri.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

bool sameBytes(ByteSpan a, ByteSpan b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

// Hands out the names of files in the document's folder.
class Names {
 public:
  explicit Names(const fs::path& location) : folder_(location.parent_path()), stem_(location.stem().string()) {
    taken_[location.filename()] = std::nullopt;
  }

  // A name for bytes that have none.
  fs::path fresh(ByteSpan bytes) {
    for (int i = 0;; ++i) {
      const fs::path path = i == 0 ? stem_ + ".bin" : fmt::format("{}_{}.bin", stem_, i);
      if (take(path, bytes)) return path;
    }
  }

  // `wanted`, unless something else has it.
  fs::path like(const fs::path& wanted, ByteSpan bytes) {
    if (!isOther(folder_ / wanted, bytes) && take(wanted, bytes)) return wanted;
    const std::string name = wanted.filename().string();
    for (int i = 0;; ++i) {
      const std::string start = i == 0 ? stem_ : fmt::format("{}_{}", stem_, i);
      const fs::path path = wanted.parent_path() / fmt::format("{}_{}", start, name);
      if (take(path, bytes)) return path;
    }
  }

  std::vector<GltfFiles::File> files() const {
    std::vector<GltfFiles::File> result;
    for (const auto& [path, bytes] : taken_) {
      if (bytes) result.push_back({path, *bytes});
    }
    return result;
  }

 private:
  // Two that want one name with the same bytes use the same file.
  bool take(const fs::path& path, ByteSpan bytes) {
    const auto [known, isNew] = taken_.try_emplace(path.lexically_normal(), bytes);
    return isNew || (known->second && sameBytes(*known->second, bytes));
  }

  static bool isOther(const fs::path& path, ByteSpan bytes) {
    std::error_code problem;
    if (!fs::exists(path, problem)) return false;
    if (!fs::is_regular_file(path, problem) || fs::file_size(path, problem) != bytes.size()) return true;
    return !sameBytes(readFile(path), bytes);
  }

  fs::path folder_;
  std::string stem_;
  std::map<fs::path, std::optional<ByteSpan>> taken_;
};

// The URI under which bytes that had `uri` are written.
std::string addFile(Names& names, const std::string& uri, ByteSpan bytes) {
  if (uri.empty()) return percentEncode(names.fresh(bytes).generic_string());
  const std::string wanted = localPath(uri);
  const std::string path = names.like(wanted, bytes).generic_string();
  return path == wanted ? uri : percentEncode(path);
}

}  // namespace

GltfFiles gltfFiles(const Asset& asset, const fs::path& location) {
  gltf::Document document = asset.document;
  Names names(location);
  for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
    const auto& [bytes, uri] = asset.buffers[i];
    const bool inside = isDataUri(uri) || bytes.empty();
    const std::string header = uri.empty() ? "data:application/octet-stream;base64," : uri;
    document.buffers[i].uri = inside ? header + encodeBase64(bytes) : addFile(names, uri, bytes);
  }
  std::map<std::string_view, std::string> imageUri;
  for (const Asset::SideFile& file : asset.sideFiles) imageUri[file.uri] = addFile(names, file.uri, file.bytes);
  for (gltf::Image& image : document.images) {
    const auto written = imageUri.find(image.uri);
    if (written != imageUri.end()) image.uri = written->second;
  }
  return {dumpJson(gltf::jsonOf(document), 2) + '\n', names.files()};
}

}  // namespace limber
