#include "limber/asset/gltf_document.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/document_errors.h"
#include "limber/asset/extensions.h"
#include "limber/asset/gltf_json.h"
#include "limber/asset/images.h"
#include "limber/asset/json_access.h"
#include "limber/asset/json_text.h"
#include "limber/asset/uri.h"

namespace limber {

namespace {

// A buffer that only stands for what compressed buffer views decode to has no bytes of its own to load.
bool isCompressionFallback(const gltf::Buffer& buffer, const std::string& place) {
  const auto isFallback = [&](const char* name) {
    const std::string path = place + ".extensions." + name;
    return JsonView(extensionOf(buffer, name), path).flag("fallback", false);
  };
  return isFallback("EXT_meshopt_compression") || isFallback("KHR_meshopt_compression");
}

Bytes resolve(std::string_view uri, const std::string& place, const Resolver& resolver) {
  std::optional<Bytes> bytes;
  const std::string path = localPath(uri);
  if (resolver) bytes = resolver(path);
  if (!bytes) {
    throw Error(ErrorCode::kFile, fmt::format("its file \"{}\" is not there", path), place,
                "put it beside the model, or use a GLB");
  }
  return std::move(*bytes);
}

Asset::Buffer loadBuffer(const gltf::Buffer& buffer, const std::string& place, std::optional<ByteSpan> binary,
                         const Resolver& resolver) {
  Asset::Buffer loaded;
  const std::size_t length = buffer.byteLength;
  if (isDataUri(buffer.uri)) {
    DataUri data = decodeDataUri(buffer.uri);
    loaded = {std::move(data.bytes), std::move(data.header)};
  } else if (!buffer.uri.empty()) {
    loaded = {resolve(buffer.uri, place, resolver), buffer.uri};
  } else if (binary) {
    // The chunk is padded to four bytes; the buffer is not.
    loaded.bytes.assign(binary->begin(), binary->begin() + std::min(length, binary->size()));
  } else if (length > 0) {
    failAt(place, "has neither a file nor a binary chunk");
  }
  if (loaded.bytes.size() < length) {
    failAt(place, fmt::format("should have {} bytes and has {}", length, loaded.bytes.size()));
  }
  return loaded;
}

void loadBuffers(Asset& asset, std::optional<ByteSpan> binary, const Resolver& resolver) {
  for (std::size_t i = 0; i < asset.document.buffers.size(); ++i) {
    gltf::Buffer& buffer = asset.document.buffers[i];
    const std::string place = fmt::format("buffers[{}]", i);
    if (isCompressionFallback(buffer, place)) {
      asset.buffers.push_back({{}, buffer.uri});
      continue;
    }
    try {
      // Only the first buffer may be the binary chunk.
      asset.buffers.push_back(loadBuffer(buffer, place, i == 0 ? binary : std::nullopt, resolver));
    } catch (const Error& error) {
      throw error.where().empty() ? error.within(place) : error;
    }
    buffer.uri = asset.buffers.back().uri;  // of a data URI its start, from here on

    // What the document does not speak of is not kept: a buffer's bytes are as many as it says.
    Bytes& bytes = asset.buffers.back().bytes;
    if (bytes.size() <= buffer.byteLength) continue;
    asset.warnings.add("trailing-bytes", "bytes behind the end of a buffer left out", place,
                       bytes.size() - buffer.byteLength);
    bytes.resize(buffer.byteLength);
  }
}

// Images are the user's to miss: what cannot be found or trusted stays a reference.
void loadImages(Asset& asset, const Resolver& resolver) {
  for (std::size_t i = 0; i < asset.document.images.size(); ++i) {
    const std::string& uri = asset.document.images[i].uri;
    if (uri.empty() || isDataUri(uri)) continue;
    const bool known = std::any_of(asset.sideFiles.begin(), asset.sideFiles.end(),
                                   [&](const Asset::SideFile& file) { return file.uri == uri; });
    if (known) continue;
    const std::string place = fmt::format("images[{}]", i);
    try {
      Bytes bytes = resolve(uri, place, resolver);
      if (imageFormat(bytes).mediaType.empty()) failAt(place, fmt::format("\"{}\" is not an image", uri));
      asset.sideFiles.push_back({uri, std::move(bytes)});
    } catch (const Error& error) {
      asset.warnings.add("missing-images",
                         "images could not be read; the references to them stay (" + error.message() + ")", place);
    }
  }
}

}  // namespace

Asset readGltfDocument(ByteSpan text, std::optional<ByteSpan> binary, const Resolver& resolver) {
  Asset asset;
  const std::string_view characters(reinterpret_cast<const char*>(text.data()), text.size());
  asset.document = gltf::documentOf(parseJson(characters, asset.warnings));
  loadBuffers(asset, binary, resolver);
  loadImages(asset, resolver);
  return asset;
}

}  // namespace limber
