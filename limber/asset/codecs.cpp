#include "limber/asset/codecs.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/codecs_detail.h"
#include "limber/asset/compact_buffers.h"
#include "limber/asset/extensions.h"

namespace limber {

namespace {

constexpr std::size_t kFreeMemory = std::size_t{32} << 20, kGrowth = 1024;

struct Found {
  std::size_t views = 0, primitives = 0;
  std::size_t total() const { return views + primitives; }
};

Found findCompressed(const Asset& asset) {
  Found found;
  const JsonView views = JsonView(asset).array("bufferViews"), meshes = JsonView(asset).array("meshes");
  for (std::size_t i = 0; i < views.size(); ++i) found.views += hasMeshopt(views[i]);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const JsonView primitives = meshes[m].array("primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      found.primitives += extensionOf(primitives[p], kDraco).exists();
    }
  }
  return found;
}

// Does the file hold the view's bytes uncompressed too?
bool hasPlainBytes(const Asset& asset, const JsonView& view) {
  const std::size_t size = asset.buffers[view.requireIndex("buffer", asset.buffers.size())].bytes.size();
  const std::size_t offset = view.count("byteOffset").value_or(0), length = view.member("byteLength").asCount();
  return offset <= size && length <= size - offset;
}

bool hasPlainAccessors(const Asset& asset, const JsonView& primitive) {
  const JsonView accessors = JsonView(asset).array("accessors"), attributes = primitive.object("attributes");
  bool plain = true;
  const auto look = [&](std::optional<Index> accessor) {
    plain = plain && (!accessor || accessors[*accessor].member("bufferView").exists());
  };
  look(primitive.index("indices", accessors.size()));
  extensionOf(primitive, kDraco).object("attributes").forEachMember([&](std::string_view name, const JsonView&) {
    look(attributes.index(name, accessors.size()));
  });
  return plain;
}

void takePlainData(Asset& asset, Decoded& decoded) {
  const JsonView views = JsonView(asset).array("bufferViews"), meshes = JsonView(asset).array("meshes");
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!hasMeshopt(views[i]) || !hasPlainBytes(asset, views[i])) continue;
    for (const char* name : kMeshopt) {
      const std::optional<Index> source = extensionOf(views[i], name).index("buffer", asset.buffers.size());
      if (source) decoded.buffers.insert(*source);
      eraseExtension(asset.json()["bufferViews"][i], name);
    }
  }
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const JsonView primitives = meshes[m].array("primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      if (!extensionOf(primitives[p], kDraco).exists() || !hasPlainAccessors(asset, primitives[p])) continue;
      eraseExtension(asset.json()["meshes"][m]["primitives"][p], kDraco);
    }
  }
}

void decode(Asset& asset, const Found& found, Decoded& decoded) {
  DecodeBudget budget(asset);
  if (found.views > 0) decodeMeshopt(asset, budget, decoded);
  if (found.primitives > 0) decodeDraco(asset, budget, decoded);
  const JsonView accessors = JsonView(asset).array("accessors");
  for (const Index accessor : decoded.accessors) {
    // Decoded values are near those from which the encoder took its bounds, not always equal to them.
    if (accessors[accessor].member("min").exists() || accessors[accessor].member("max").exists()) {
      setBounds(asset, accessor);
    }
  }
}

// What says of the whole document that it is compressed.
void dropDeclarations(Asset& asset) {
  for (const char* name : {kDraco, kMeshopt[0], kMeshopt[1]}) undeclareExtension(asset.json(), name);
  for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
    for (const char* name : kMeshopt) eraseExtension(asset.json()["buffers"][i], name);
  }
}

}  // namespace

DecodeBudget::DecodeBudget(const Asset& asset) : left_(kFreeMemory) {
  for (const Asset::Buffer& buffer : asset.buffers) left_ += kGrowth * buffer.bytes.size();
}

void DecodeBudget::take(std::size_t bytes, const std::string& where) {
  if (bytes > left_) {
    throw Error(ErrorCode::kLimit, "decompresses to more than a file of this size may hold", where);
  }
  left_ -= bytes;
}

bool hasMeshopt(const JsonView& view) {
  return extensionOf(view, kMeshopt[0]).exists() || extensionOf(view, kMeshopt[1]).exists();
}

void decompress(Asset& asset) {
  const std::size_t compressed = findCompressed(asset).total();
  if (compressed == 0) return;
  Decoded decoded;
  takePlainData(asset, decoded);
  decode(asset, findCompressed(asset), decoded);
  dropUnusedBytes(asset, decoded.buffers);
  removeEmptyBuffers(asset);
  dropDeclarations(asset);
  asset.warnings.add("decompressed", "compressed buffer views and meshes decompressed; they are written uncompressed",
                     {}, compressed);
}

}  // namespace limber
