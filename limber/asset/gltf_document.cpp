#include "limber/asset/gltf_document.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/images.h"
#include "limber/asset/json_access.h"
#include "limber/asset/json_text.h"
#include "limber/asset/uri.h"

namespace limber {

namespace {

// Major version of "2.0"; nothing if the text is no version.
std::optional<int> majorVersion(std::string_view version) {
  int major = 0;
  const auto [end, problem] = std::from_chars(version.data(), version.data() + version.size(), major);
  if (problem != std::errc() || end == version.data() + version.size() || *end != '.') return std::nullopt;
  return major;
}

void checkVersion(const JsonView& root) {
  const JsonView asset = root.object("asset");
  if (!asset.exists()) root.fail("is no glTF: it has no \"asset\" object");
  const std::string_view version = asset.text("version"), minimum = asset.text("minVersion", "2.0");
  const std::optional<int> major = majorVersion(version);
  if (!major) asset.member("version").fail("is missing or no version");
  if (*major == 2 && minimum == "2.0") return;
  throw Error(ErrorCode::kUnsupported,
              fmt::format("is glTF {}, limber reads glTF 2.0", *major == 2 ? minimum : version), {},
              "export the model as glTF 2.0");
}

// A buffer that only stands for what compressed buffer views decode to has no bytes of its own to load.
bool isCompressionFallback(const JsonView& buffer) {
  const JsonView extensions = buffer.object("extensions");
  return extensions.object("EXT_meshopt_compression").flag("fallback", false) ||
         extensions.object("KHR_meshopt_compression").flag("fallback", false);
}

Bytes resolve(const JsonView& owner, std::string_view uri, const Resolver& resolver) {
  std::optional<Bytes> bytes;
  const std::string path = localPath(uri);
  if (resolver) bytes = resolver(path);
  if (!bytes) {
    throw Error(ErrorCode::kFile, fmt::format("its file \"{}\" is not there", path), owner.path(),
                "put it beside the model, or use a GLB");
  }
  return std::move(*bytes);
}

Asset::Buffer loadBuffer(const JsonView& buffer, std::optional<ByteSpan> binary, const Resolver& resolver) {
  Asset::Buffer loaded;
  const std::string_view uri = buffer.text("uri");
  if (isCompressionFallback(buffer)) {
    loaded.uri = uri;
    return loaded;
  }
  const std::size_t length = buffer.member("byteLength").asCount();
  if (isDataUri(uri)) {
    DataUri data = decodeDataUri(uri);
    loaded = {std::move(data.bytes), std::move(data.header)};
  } else if (!uri.empty()) {
    loaded = {resolve(buffer, uri, resolver), std::string(uri)};
  } else if (binary) {
    // The chunk is padded to four bytes; the buffer is not.
    loaded.bytes.assign(binary->begin(), binary->begin() + std::min(length, binary->size()));
  } else if (length > 0) {
    buffer.fail("has neither a file nor a binary chunk");
  }
  if (loaded.bytes.size() < length) {
    buffer.fail(fmt::format("should have {} bytes and has {}", length, loaded.bytes.size()));
  }
  return loaded;
}

// What the document does not speak of is not kept: from here on a buffer's bytes are as many as it says.
void trimBuffer(Asset& asset, const JsonView& buffer) {
  Bytes& bytes = asset.buffers.back().bytes;
  const std::size_t length = buffer.count("byteLength").value_or(0);
  if (isCompressionFallback(buffer) || bytes.size() <= length) return;
  asset.warnings.add("trailing-bytes", "bytes behind the end of a buffer left out", buffer.path(),
                     bytes.size() - length);
  bytes.resize(length);
}

void loadBuffers(Asset& asset, std::optional<ByteSpan> binary, const Resolver& resolver) {
  const JsonView buffers = JsonView(asset).array("buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    try {
      // Only the first buffer may be the binary chunk.
      asset.buffers.push_back(loadBuffer(buffers[i], i == 0 ? binary : std::nullopt, resolver));
      trimBuffer(asset, buffers[i]);
    } catch (const Error& error) {
      throw error.where().empty() ? error.within(buffers[i].path()) : error;
    }
  }
  // The decoded bytes replace the text; its start is kept, in its place, for writing.
  for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
    if (isDataUri(asset.buffers[i].uri)) asset.json()["buffers"][i]["uri"] = asset.buffers[i].uri;
  }
}

// Images are the user's to miss: what cannot be found or trusted stays a reference.
void loadImages(Asset& asset, const Resolver& resolver) {
  const JsonView images = JsonView(asset).array("images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string uri(images[i].text("uri"));
    if (uri.empty() || isDataUri(uri)) continue;
    const bool known = std::any_of(asset.sideFiles.begin(), asset.sideFiles.end(),
                                   [&](const Asset::SideFile& file) { return file.uri == uri; });
    if (known) continue;
    try {
      Bytes bytes = resolve(images[i], uri, resolver);
      if (imageFormat(bytes).mediaType.empty()) images[i].fail(fmt::format("\"{}\" is not an image", uri));
      asset.sideFiles.push_back({uri, std::move(bytes)});
    } catch (const Error& error) {
      asset.warnings.add("missing-images",
                         "images could not be read; the references to them stay (" + error.message() + ")",
                         images[i].path());
    }
  }
}

}  // namespace

Asset readGltfDocument(ByteSpan text, std::optional<ByteSpan> binary, const Resolver& resolver) {
  Asset asset;
  asset.json() = parseJson({reinterpret_cast<const char*>(text.data()), text.size()}, asset.warnings);
  const JsonView root(asset);
  root.requireObject();
  checkVersion(root);
  loadBuffers(asset, binary, resolver);
  loadImages(asset, resolver);
  return asset;
}

}  // namespace limber
