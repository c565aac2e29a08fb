#include "limber/document/gltf/codecs/codecs.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/codecs/codecs_detail.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"

namespace limber {

namespace {

struct Found {
  std::size_t views = 0, primitives = 0;
  std::size_t total() const { return views + primitives; }
};

Found findCompressed(const gltf::Document& document) {
  Found found;
  for (const gltf::BufferView& view : document.bufferViews) found.views += meshoptOf(view) != nullptr;
  for (const gltf::Mesh& mesh : document.meshes) {
    for (const gltf::Primitive& primitive : mesh.primitives) {
      found.primitives += extensionOf(primitive, kDraco) != nullptr;
    }
  }
  return found;
}

// Does the file hold the view's bytes uncompressed too?
bool hasPlainBytes(const Asset& asset, Index index) {
  const gltf::BufferView& view = asset.document.bufferViews[index];
  requireElement(view.buffer, asset.buffers.size(), [&] { return fmt::format("bufferViews[{}].buffer", index); });
  const std::size_t size = asset.buffers[view.buffer].bytes.size();
  return view.byteOffset <= size && view.byteLength <= size - view.byteOffset;
}

bool hasPlainAccessors(const gltf::Document& document, const gltf::Primitive& primitive, const std::string& location) {
  bool plain = true;
  const auto look = [&](std::optional<Index> accessor, std::string_view name) {
    requireElement(accessor, document.accessors.size(), [&] { return fmt::format("{}.{}", location, name); });
    plain = plain && (!accessor || document.accessors[*accessor].bufferView);
  };
  look(primitive.indices, "indices");
  const std::string path = fmt::format("{}.extensions.{}", location, kDraco);
  JsonView(extensionOf(primitive, kDraco), path)
      .object("attributes")
      .forEachMember([&](std::string_view name, const JsonView&) {
        look(primitive.attributes.find(name), fmt::format("attributes.{}", name));
      });
  return plain;
}

void takePlainData(Asset& asset, Decoded& decoded) {
  gltf::Document& document = asset.document;
  for (Index i = 0; i < document.bufferViews.size(); ++i) {
    gltf::BufferView& view = document.bufferViews[i];
    if (meshoptOf(view) == nullptr || !hasPlainBytes(asset, i)) continue;
    for (const char* name : kMeshopt) {
      const std::string path = fmt::format("bufferViews[{}].extensions.{}", i, name);
      const JsonView extension(extensionOf(view, name), path);
      if (const auto source = extension.index("buffer", asset.buffers.size())) decoded.buffers.insert(*source);
      eraseExtension(view, name);
    }
  }
  for (std::size_t m = 0; m < document.meshes.size(); ++m) {
    std::vector<gltf::Primitive>& primitives = document.meshes[m].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      if (extensionOf(primitives[p], kDraco) == nullptr) continue;
      const std::string location = fmt::format("meshes[{}].primitives[{}]", m, p);
      if (hasPlainAccessors(document, primitives[p], location)) eraseExtension(primitives[p], kDraco);
    }
  }
}

void decode(Asset& asset, const Found& found, Decoded& decoded) {
  std::uint64_t stored = 0;
  for (const Asset::Buffer& buffer : asset.buffers) stored += buffer.bytes.size();
  DecodeBudget meshopt(read_bounds::kMeshopt.larger(stored)), draco(read_bounds::kDraco.of(stored));
  if (found.views > 0) decodeMeshopt(asset, meshopt, decoded);
  if (found.primitives > 0) decodeDraco(asset, draco, decoded);
  for (const Index index : decoded.accessors) {
    // Decoded values are near those from which the encoder took its bounds, not always equal to them.
    const gltf::Accessor& accessor = asset.document.accessors[index];
    if (!accessor.min.empty() || !accessor.max.empty()) setBounds(asset, index);
  }
}

// What says of the whole document that it is compressed.
void dropDeclarations(gltf::Document& document) {
  for (const char* name : {kDraco, kMeshopt[0], kMeshopt[1]}) undeclareExtension(document, name);
  for (gltf::Buffer& buffer : document.buffers) {
    for (const char* name : kMeshopt) eraseExtension(buffer, name);
  }
}

}  // namespace

void DecodeBudget::take(std::size_t bytes, const std::string& where) {
  if (bytes > left_) {
    throw Error(ErrorCode::kLimit, "decompresses to more than a file of this size may hold", where,
                "export the model without compression");
  }
  left_ -= bytes;
}

const char* meshoptOf(const gltf::BufferView& view) {
  for (const char* name : kMeshopt) {
    if (extensionOf(view, name) != nullptr) return name;
  }
  return nullptr;
}

void decompress(Asset& asset) {
  const std::size_t compressed = findCompressed(asset.document).total();
  if (compressed == 0) return;
  Decoded decoded;
  takePlainData(asset, decoded);
  decode(asset, findCompressed(asset.document), decoded);
  dropUnusedBytes(asset, decoded.buffers);
  removeEmptyBuffers(asset);
  dropDeclarations(asset.document);
  asset.warnings.add("decompressed", "compressed buffer views and meshes decompressed; they are written uncompressed",
                     {}, compressed);
}

}  // namespace limber
