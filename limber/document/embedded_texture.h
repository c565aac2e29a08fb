// Pictures put into a document.
#pragma once

#include <optional>
#include <string_view>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// A new picture that is embedded, named after its path. None, with a warning "missing-images" or "unsupported-images",
// where there are no bytes or they are neither PNG nor JPEG.
std::optional<Index> addEmbeddedImage(Asset& asset, std::string_view path, const std::optional<Bytes>& bytes);

// The same, and a new texture of it, which is returned.
std::optional<Index> addEmbeddedTexture(Asset& asset, std::string_view path, const std::optional<Bytes>& bytes);

}  // namespace limber
