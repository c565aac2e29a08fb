#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/codec_library.h"
#include "limber/asset/codecs_detail.h"
#include "limber/asset/extensions.h"

namespace limber {

namespace {

// One compressed buffer view.
struct EncodedView {
  std::size_t view = 0;
  Index target = 0;  // buffer that the decoded bytes belong to
  Index source = 0;
  MeshoptData data;
};

EncodedView readEncoded(const Asset& asset, const JsonView& view, const JsonView& extension) {
  EncodedView encoded;
  encoded.target = view.requireIndex("buffer", asset.buffers.size());
  if (!asset.buffers[encoded.target].bytes.empty()) view.fail("reaches beyond its buffer");
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
  const std::size_t decodedSize = view.member("byteLength").asCount();
  if (data.stride == 0 || data.stride > 256 || data.count != decodedSize / data.stride ||
      decodedSize % data.stride != 0) {
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
  const JsonView views = JsonView(asset).array("bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!hasMeshopt(views[i])) continue;
    const JsonView first = extensionOf(views[i], kMeshopt[0]);
    const JsonView extension = first.exists() ? first : extensionOf(views[i], kMeshopt[1]);
    found.push_back(readEncoded(asset, views[i], extension));
    found.back().view = i;
    checkShape(found.back().data, extension);
  }
  return found;
}

}  // namespace

// The decoded bytes fill the buffer that stands for them, one view behind the other, at offsets of our own: those in
// the file are a claim about memory.
void decodeMeshopt(Asset& asset, DecodeBudget& budget, Decoded& decoded) {
  const std::vector<EncodedView> views = findEncoded(asset);
  std::vector<Bytes> filled(asset.buffers.size());
  std::vector<std::size_t> offsets;
  for (const EncodedView& encoded : views) {
    const std::string where = fmt::format("bufferViews[{}]", encoded.view);
    Bytes& out = filled[encoded.target];
    const std::size_t offset = (out.size() + 3) / 4 * 4, size = encoded.data.count * encoded.data.stride;
    budget.take(size, where);
    out.resize(offset + size);
    if (size > 0 && !decodeMeshoptData(encoded.data, out.data() + offset)) {
      throw Error(ErrorCode::kBadData, "its meshopt compressed data are broken", where);
    }
    offsets.push_back(offset);
    decoded.buffers.insert(encoded.source);
  }

  std::vector<bool> isNew(JsonView(asset).array("bufferViews").size(), false);
  for (std::size_t i = 0; i < views.size(); ++i) {
    Json& view = asset.json()["bufferViews"][views[i].view];
    view["byteOffset"] = offsets[i];
    for (const char* name : kMeshopt) eraseExtension(view, name);
    isNew[views[i].view] = true;
  }
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (filled[i].empty()) continue;
    asset.json()["buffers"][i]["byteLength"] = filled[i].size();
    asset.json()["buffers"][i].erase("uri");
    asset.buffers[i] = {std::move(filled[i]), {}};
  }
  const JsonView accessors = JsonView(asset).array("accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const auto view = accessors[i].index("bufferView", isNew.size());
    if (view && isNew[*view]) decoded.accessors.insert(static_cast<Index>(i));
  }
}

}  // namespace limber
