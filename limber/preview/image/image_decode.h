// PNG and JPEG files to pixels.
#pragma once

#include <optional>

#include "limber/preview/image/image.h"

namespace limber {

struct DecodedImage {
  Image colors;                     // as they are stored, whatever their alpha
  std::vector<std::uint8_t> alpha;  // a byte for each pixel; empty where all are opaque
};

// None where the file is neither, is damaged, is a JPEG for print (CMYK), or is larger than 2^24 pixels (2^26 where
// the file has a byte for every 64 pixels), so that a small file cannot ask for much memory or time.
std::optional<DecodedImage> decodeImage(ByteSpan file);

}  // namespace limber
