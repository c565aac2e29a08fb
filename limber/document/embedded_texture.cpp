#include "limber/document/embedded_texture.h"

#include <string>
#include <utility>

#include "limber/document/gltf/accessor.h"
#include "limber/document/images.h"
#include "limber/document/utf8.h"

namespace limber {

std::optional<Index> addEmbeddedImage(Asset& asset, std::string_view path, const std::optional<Bytes>& bytes) {
  if (!bytes) {
    asset.warnings.add("missing-images", "textures that cannot be found are left out", validUtf8(path));
    return std::nullopt;
  }
  const std::string_view mime = imageFormat(*bytes).mediaType;
  if (mime.empty()) {
    asset.warnings.add("unsupported-images", "textures that are neither PNG nor JPEG are left out", validUtf8(path));
    return std::nullopt;
  }
  gltf::Image image;
  image.name = validUtf8(path);
  image.bufferView = addBufferView(asset, *bytes);
  image.mimeType = mime;
  return addElement(asset.document.images, std::move(image));
}

std::optional<Index> addEmbeddedTexture(Asset& asset, std::string_view path, const std::optional<Bytes>& bytes) {
  const std::optional<Index> image = addEmbeddedImage(asset, path, bytes);
  if (!image) return std::nullopt;
  gltf::Texture texture;
  texture.source = *image;
  return addElement(asset.document.textures, std::move(texture));
}

}  // namespace limber
