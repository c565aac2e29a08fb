// The images of a document as the files that they are.
#pragma once

#include <optional>
#include <string_view>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// What the first bytes of an image tell: "image/png" and ".png"; both empty if it is none that a glTF file may hold.
struct ImageFormat {
  std::string_view mediaType, extension;
};
ImageFormat imageFormat(ByteSpan bytes);

// The bytes of an image of the document: in a buffer view, in a data URI, or in a file that was read with it. None
// where they could not be read.
std::optional<Bytes> imageBytes(const Asset& asset, Index image);

}  // namespace limber
