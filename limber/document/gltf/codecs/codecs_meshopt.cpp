#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limber/document/gltf/codecs/codec_library.h"
#include "limber/document/gltf/codecs/codecs_detail.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"

namespace limber {

namespace {

// One compressed buffer view.
struct EncodedView {
  Index view = 0;
  Index target = 0;  // buffer that the decoded bytes belong to
  Index source = 0;
  MeshoptData data;
};

EncodedView readEncoded(const Asset& asset, Index index, const JsonView& extension) {
  const gltf::BufferView& view = asset.document.bufferViews[index];
  const std::string location = fmt::format("bufferViews[{}]", index);
  EncodedView encoded;
  encoded.view = index;
  encoded.target = view.buffer;
  requireElement(view.buffer, asset.buffers.size(), [&] { return location + ".buffer"; });
  if (!asset.buffers[encoded.target].bytes.empty()) failAt(location, "reaches beyond its buffer");
  encoded.source = extension.requireIndex("buffer", asset.buffers.size());
  const Bytes& source = asset.buffers[encoded.source].bytes;
  const std::size_t offset = extension.count("byteOffset").value_or(0);
  const std::size_t length = extension.member("byteLength").asCount();
  if (offset > source.size() || length > source.size() - offset) extension.fail("reaches beyond its buffer");
  MeshoptData& data = encoded.data;
  data.bytes = ByteSpan(source).subspan(offset, length);
  data.count = extension.member("count").asCount();
  data.stride = extension.member("byteStride").asCount();
  data.mode = extension.text("mode");
  data.filter = extension.text("filter", "NONE");
  if (data.stride == 0 || data.stride > 256 || data.count != view.byteLength / data.stride ||
      view.byteLength % data.stride != 0) {
    extension.fail("its count and byteStride do not make up the byteLength of its buffer view");
  }
  return encoded;
}

// The decoders' own rules, which they only assert.
void checkShape(const MeshoptData& data, const JsonView& extension) {
  const bool isIndex = data.mode == "TRIANGLES" || data.mode == "INDICES";
  bool fits = data.mode == "ATTRIBUTES" ? data.stride % 4 == 0 : isIndex && (data.stride == 2 || data.stride == 4);
  if (data.mode == "TRIANGLES") fits = fits && data.count % 3 == 0;
  if (data.filter == "OCTAHEDRAL") {
    fits = fits && !isIndex && (data.stride == 4 || data.stride == 8);
  } else if (data.filter == "QUATERNION") {
    fits = fits && !isIndex && data.stride == 8;
  } else if (data.filter == "EXPONENTIAL") {
    fits = fits && !isIndex;
  } else if (data.filter != "NONE") {
    throw Error(ErrorCode::kUnsupported, fmt::format("is compressed with the filter {}", data.filter), extension.path(),
                "export the model without compression");
  }
  if (!fits) extension.fail("its mode, filter, count and byteStride do not go together");
}

std::vector<EncodedView> findEncoded(const Asset& asset) {
  std::vector<EncodedView> found;
  const std::vector<gltf::BufferView>& views = asset.document.bufferViews;
  for (Index i = 0; i < views.size(); ++i) {
    const char* name = meshoptOf(views[i]);
    if (name == nullptr) continue;
    const std::string path = fmt::format("bufferViews[{}].extensions.{}", i, name);
    const JsonView extension(extensionOf(views[i], name), path);
    extension.requireObject();
    found.push_back(readEncoded(asset, i, extension));
    checkShape(found.back().data, extension);
  }
  return found;
}

}  // namespace

// The decoded bytes fill the fallback buffer, one view after the other, at offsets of our own: those in the file are a
// claim about memory.
void decodeMeshopt(Asset& asset, DecodeBudget& budget, Decoded& decoded) {
  const std::vector<EncodedView> views = findEncoded(asset);
  std::vector<std::size_t> sizes(asset.buffers.size(), 0), offsets;
  for (const EncodedView& encoded : views) {
    std::size_t& end = sizes[encoded.target];
    const std::size_t size = encoded.data.count * encoded.data.stride;
    budget.take(size, fmt::format("bufferViews[{}]", encoded.view));
    offsets.push_back((end + 3) / 4 * 4);
    end = offsets.back() + size;
  }
  std::vector<Bytes> filled(sizes.begin(), sizes.end());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const EncodedView& encoded = views[i];
    if (encoded.data.count > 0 && !decodeMeshoptData(encoded.data, filled[encoded.target].data() + offsets[i])) {
      throw Error(ErrorCode::kBadData, "its meshopt compressed data are broken",
                  fmt::format("bufferViews[{}]", encoded.view));
    }
    decoded.buffers.insert(encoded.source);
  }

  gltf::Document& document = asset.document;
  std::vector<bool> isNew(document.bufferViews.size(), false);
  for (std::size_t i = 0; i < views.size(); ++i) {
    gltf::BufferView& view = document.bufferViews[views[i].view];
    view.byteOffset = offsets[i];
    for (const char* name : kMeshopt) eraseExtension(view, name);
    isNew[views[i].view] = true;
  }
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (filled[i].empty()) continue;
    document.buffers[i].byteLength = filled[i].size();
    document.buffers[i].uri.clear();
    asset.buffers[i] = {std::move(filled[i]), {}};
  }
  for (Index a = 0; a < document.accessors.size(); ++a) {
    const std::optional<Index> view = document.accessors[a].bufferView;
    requireElement(view, isNew.size(), [&] { return fmt::format("accessors[{}].bufferView", a); });
    if (view && isNew[*view]) decoded.accessors.insert(a);
  }
}

}  // namespace limber
