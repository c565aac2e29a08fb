#include "limber/document/images.h"

#include <array>
#include <cstddef>

#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/uri.h"

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
  const gltf::Image& source = asset.document.images[image];
  if (source.bufferView) {
    const ByteSpan bytes = viewLayout(asset, *source.bufferView).bytes;
    return Bytes(bytes.begin(), bytes.end());
  }
  if (isDataUri(source.uri)) return decodeDataUri(source.uri).bytes;
  for (const Asset::SideFile& file : asset.sideFiles) {
    if (file.uri == source.uri) return file.bytes;
  }
  return std::nullopt;
}

}  // namespace limber
