// From the text of a glTF document and its binary chunk to an Asset with all its bytes.
#pragma once

#include <optional>

#include "limber/document/read.h"

namespace limber {

// `text` is the JSON, `binary` a GLB's binary chunk. Loads buffers and images (through `resolver`, which gets decoded
// relative paths). The result is not checked further. Throws Error as readAsset does, without the document's name.
Asset readGltfDocument(ByteSpan text, std::optional<ByteSpan> binary, const Resolver& resolver);

}  // namespace limber
