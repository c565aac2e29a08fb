#include "limber/asset/images.h"

#include <array>
#include <cstddef>

#include <nlohmann/json.hpp>

#include "limber/asset/json_access.h"
#include "limber/asset/uri.h"

namespace limber {

ImageFormat imageFormat(ByteSpan bytes) {
  struct Signature {
    std::string_view start;
    ImageFormat format;
    std::size_t at = 0;
  };
  static constexpr std::array<Signature, 5> kSignatures = {{{"\x89PNG\r\n\x1a\n", {"image/png", ".png"}},
                                                            {"\xff\xd8\xff", {"image/jpeg", ".jpg"}},
                                                            {"WEBP", {"image/webp", ".webp"}, 8},
                                                            {"\xabKTX 20\xbb", {"image/ktx2", ".ktx2"}},
                                                            {"DDS ", {"image/vnd-ms.dds", ".dds"}}}};
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Signature& signature : kSignatures) {
    if (text.size() < signature.at + signature.start.size()) continue;
    if (text.compare(signature.at, signature.start.size(), signature.start) == 0) return signature.format;
  }
  return {};
}

std::optional<Bytes> imageBytes(const Asset& asset, Index image) {
  const JsonView views = JsonView(asset).array("bufferViews"), json = JsonView(asset).array("images")[image];
  if (const std::optional<Index> number = json.index("bufferView", views.size())) {
    const JsonView view = views[*number];
    const Bytes& buffer = asset.buffers[view.requireIndex("buffer", asset.buffers.size())].bytes;
    const std::size_t offset = view.count("byteOffset").value_or(0), length = view.member("byteLength").asCount();
    return Bytes(buffer.begin() + static_cast<std::ptrdiff_t>(offset),
                 buffer.begin() + static_cast<std::ptrdiff_t>(offset + length));
  }
  const std::string uri(json.text("uri"));
  if (isDataUri(uri)) return decodeDataUri(uri).bytes;
  for (const Asset::SideFile& file : asset.sideFiles) {
    if (file.uri == uri) return file.bytes;
  }
  return std::nullopt;
}

}  // namespace limber
