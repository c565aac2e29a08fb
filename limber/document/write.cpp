#include "limber/document/write.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/text/names.h"
#include "limber/document/gltf/glb.h"
#include "limber/document/gltf/gltf_files.h"
#include "limber/document/gltf/gltf_json.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/images.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

// All buffers one behind the other; moves the document's buffer views along.
BinaryChunk mergeBuffers(const Asset& asset, gltf::Document& document) {
  BinaryChunk binary;
  std::vector<std::size_t> start;
  for (const Asset::Buffer& buffer : asset.buffers) start.push_back(binary.add(buffer.bytes));
  for (gltf::BufferView& view : document.bufferViews) {
    if (view.buffer == 0) continue;
    view.byteOffset += start.at(view.buffer);
    view.buffer = 0;
  }
  return binary;
}

// Images beside the document become buffer views at the end; an image used twice is stored once.
void embedImages(const Asset& asset, gltf::Document& document, BinaryChunk& binary) {
  std::map<std::string_view, const Asset::SideFile*> files;
  for (const Asset::SideFile& file : asset.sideFiles) files[file.uri] = &file;
  std::map<const Asset::SideFile*, Index> viewOf;
  for (gltf::Image& image : document.images) {
    const auto file = files.find(image.uri);
    if (file == files.end()) continue;
    const Bytes& bytes = file->second->bytes;
    const auto [known, isNew] = viewOf.try_emplace(file->second, static_cast<Index>(document.bufferViews.size()));
    if (isNew) {
      gltf::BufferView view;
      view.byteOffset = binary.add(bytes);
      view.byteLength = bytes.size();
      document.bufferViews.push_back(std::move(view));
    }
    image.uri.clear();
    image.mimeType = imageFormat(bytes).mediaType;
    image.bufferView = known->second;
  }
}

// Only one buffer can be the binary chunk. The first one's name and extras stay; the others have none to stand in.
void setSingleBuffer(gltf::Document& document, std::size_t size) {
  if (size == 0 && document.buffers.empty()) return;
  document.buffers.resize(1);
  document.buffers[0].uri.clear();
  document.buffers[0].byteLength = size;
}

// A GLB in pieces, most of which stay in the asset.
struct Glb {
  explicit Glb(const Asset& asset) {
    gltf::Document document = asset.document;
    binary = mergeBuffers(asset, document);
    embedImages(asset, document, binary);
    setSingleBuffer(document, binary.size);
    head = glbHead(dumpJson(gltf::jsonOf(document), -1), binary);
  }

  BinaryChunk binary;
  Bytes head;
};

// The folders that a file needs and that are not there yet; gone again unless kept.
class NewFolders {
 public:
  ~NewFolders() {
    std::error_code ignored;
    for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, ignored);
  }
  void make(const fs::path& folder) {
    std::error_code problem;
    if (folder.empty() || fs::exists(folder, problem)) return;
    make(folder.parent_path());
    if (!fs::create_directory(folder, problem)) {
      throw Error(ErrorCode::kFile, "folder cannot be made: " + problem.message(), folder.string());
    }
    made_.push_back(folder);
  }
  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;
};

void writeGltf(const Asset& asset, const fs::path& path, std::vector<OutputFile> outputs) {
  const GltfFiles files = gltfFiles(asset, path);
  NewFolders folders;
  for (const GltfFiles::File& file : files.beside) {
    outputs.push_back({path.parent_path() / file.path, file.bytes});
    if (file.path.has_parent_path()) folders.make(outputs.back().path.parent_path());
  }
  outputs.push_back({path, asBytes(files.json)});  // last, so that it never exists without what it refers to
  writeFiles(outputs);
  folders.keep();
}

}  // namespace

Bytes writeGlb(const Asset& asset) {
  const Glb glb(asset);
  Bytes file = glb.head;
  file.reserve(file.size() + glb.binary.size + 3);
  for (const ByteSpan piece : glb.binary.pieces) file.insert(file.end(), piece.begin(), piece.end());
  return file;
}

void writeAsset(const Asset& asset, const fs::path& path, std::span<const OutputFile> companions) {
  const std::string extension = lowerExtension(path);
  if (path == "-" || extension == ".glb") {
    const Glb glb(asset);
    std::vector<OutputFile> outputs(companions.begin(), companions.end());
    outputs.push_back({path, glb.head, glb.binary.pieces});
    writeFiles(outputs);
  } else if (extension == ".gltf") {
    writeGltf(asset, path, {companions.begin(), companions.end()});
  } else {
    throw Error(ErrorCode::kBadArgument, "cannot be written: only GLB and glTF can", path.string(),
                "give the output a name that ends in .glb or .gltf");
  }
}

}  // namespace limber
