// What a .gltf file comes with: its buffers and images as files beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limber/document/asset.h"

namespace limber {

struct GltfFiles {
  struct File {
    std::filesystem::path path;  // relative to the document's folder
    ByteSpan bytes;              // of the asset
  };
  std::string json;
  std::vector<File> beside;
};

// The document as it is to be written at `location`. Buffers and images that had a file keep its name (and folder),
// others become <stem>.bin, <stem>_1.bin, ...; data URIs stay such. Where another file of that name exists already,
// with other bytes, the new file's name gets the stem as a prefix: an older model keeps what it refers to.
GltfFiles gltfFiles(const Asset& asset, const std::filesystem::path& location);

}  // namespace limber
