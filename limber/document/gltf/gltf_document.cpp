#include "limber/document/gltf/gltf_document.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/file/read_bounds.h"
#include "limber/core/text/printable.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/gltf_json.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/images.h"
#include "limber/document/uri.h"

namespace limber {

namespace {

// A fallback buffer, which compressed buffer views decode to, has no bytes of its own to load.
bool isCompressionFallback(const gltf::Buffer& buffer, const std::string& location) {
  const auto isFallback = [&](const char* name) {
    const std::string path = location + ".extensions." + name;
    return JsonView(extensionOf(buffer, name), path).flag("fallback", false);
  };
  return isFallback("EXT_meshopt_compression") || isFallback("KHR_meshopt_compression");
}

// The files beside the model. One that is named again is read again; hostile documents do so by the hundred.
class FilesBeside {
 public:
  explicit FilesBeside(const Resolver& resolver) : resolver_(resolver) {}

  Bytes read(std::string_view uri, const std::string& location) {
    const std::string path = localPath(uri);
    std::size_t& size = sizes_[std::filesystem::path(path).lexically_normal().generic_string()];
    if (size > 0 && repeated_ + size > kMaxRepeated) {
      throw Error(ErrorCode::kLimit,
                  fmt::format("its file \"{}\" was named before, and files named again come to more than {} MB",
                              shortened(path), kMaxRepeated >> 20),
                  location, "name each file once");
    }
    repeated_ += size;
    std::optional<Bytes> bytes;
    if (resolver_) bytes = resolver_(path);
    if (!bytes) {
      throw Error(ErrorCode::kFile, fmt::format("its file \"{}\" is not there", shortened(path)), location,
                  "put it beside the model, or use a GLB");
    }
    size = bytes->size();
    return std::move(*bytes);
  }

 private:
  static constexpr std::uint64_t kMaxRepeated = read_bounds::kRepeatedFiles.of(0);

  const Resolver& resolver_;
  std::map<std::string, std::size_t> sizes_;  // of the files by path; 0 where there is none
  std::size_t repeated_ = 0;                  // bytes
};

Asset::Buffer loadBuffer(const gltf::Buffer& buffer, const std::string& location, std::optional<ByteSpan> binary,
                         FilesBeside& files) {
  Asset::Buffer loaded;
  const std::size_t length = buffer.byteLength;
  if (isDataUri(buffer.uri)) {
    DataUri data = decodeDataUri(buffer.uri);
    loaded = {std::move(data.bytes), std::move(data.header)};
  } else if (!buffer.uri.empty()) {
    loaded = {files.read(buffer.uri, location), buffer.uri};
  } else if (binary) {
    // The chunk is padded to four bytes; the buffer is not.
    loaded.bytes.assign(binary->begin(), binary->begin() + std::min(length, binary->size()));
  } else if (length > 0) {
    failAt(location, "has neither a file nor a binary chunk");
  }
  if (loaded.bytes.size() < length) {
    failAt(location, fmt::format("should have {} bytes and has {}", length, loaded.bytes.size()));
  }
  return loaded;
}

void loadBuffers(Asset& asset, std::optional<ByteSpan> binary, FilesBeside& files) {
  for (std::size_t i = 0; i < asset.document.buffers.size(); ++i) {
    gltf::Buffer& buffer = asset.document.buffers[i];
    const std::string location = fmt::format("buffers[{}]", i);
    if (isCompressionFallback(buffer, location)) {
      asset.buffers.push_back({{}, buffer.uri});
      continue;
    }
    try {
      // Only the first buffer may be the binary chunk.
      asset.buffers.push_back(loadBuffer(buffer, location, i == 0 ? binary : std::nullopt, files));
    } catch (const Error& error) {
      throw error.where().empty() ? error.within(location) : error;
    }
    buffer.uri = asset.buffers.back().uri;  // of a data URI its start, from here on

    // What the document does not speak of is not kept: a buffer's bytes are as many as it says.
    Bytes& bytes = asset.buffers.back().bytes;
    if (bytes.size() <= buffer.byteLength) continue;
    asset.warnings.add("trailing-bytes", "bytes behind the end of a buffer left out", location,
                       bytes.size() - buffer.byteLength);
    bytes.resize(buffer.byteLength);
  }
}

// Images are the user's to miss: what cannot be found or trusted stays a reference.
void loadImages(Asset& asset, FilesBeside& files) {
  std::map<std::string, std::string> problems;  // of each URI that was met; empty where its file was read
  for (std::size_t i = 0; i < asset.document.images.size(); ++i) {
    const std::string& uri = asset.document.images[i].uri;
    if (uri.empty() || isDataUri(uri)) continue;
    const std::string location = fmt::format("images[{}]", i);
    const auto [met, isNew] = problems.try_emplace(uri);
    if (isNew) {
      try {
        Bytes bytes = files.read(uri, location);
        if (imageFormat(bytes).mediaType.empty())
          failAt(location, fmt::format("\"{}\" is not an image", shortened(uri)));
        asset.sideFiles.push_back({uri, std::move(bytes)});
      } catch (const Error& error) {
        met->second = error.message();
      }
    }
    if (met->second.empty()) continue;
    asset.warnings.add("missing-images", "images could not be read; the references to them stay (" + met->second + ")",
                       location);
  }
}

// parseJson; what its errors quote of the text is cut.
Json parseDocument(std::string_view text, Warnings& warnings) {
  constexpr std::size_t kMax = 200;
  try {
    return parseJson(text, warnings);
  } catch (const Error& error) {
    throw Error(error.code(), shortened(error.message(), kMax), error.where(), error.remedy());
  }
}

}  // namespace

Asset readGltfDocument(ByteSpan text, std::optional<ByteSpan> binary, const Resolver& resolver) {
  Asset asset;
  const std::string_view characters(reinterpret_cast<const char*>(text.data()), text.size());
  asset.document = gltf::documentOf(parseDocument(characters, asset.warnings), characters.size());
  FilesBeside files(resolver);
  loadBuffers(asset, binary, files);
  loadImages(asset, files);
  return asset;
}

}  // namespace limber
