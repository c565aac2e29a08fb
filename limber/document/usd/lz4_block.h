// LZ4's block format (github.com/lz4/lz4, doc/lz4_Block_format.md), which USD's crates are packed in.
#pragma once

#include "limber/core/file/file.h"

namespace limber {

// One block; takes greedily the longest match found by a table of recent positions. Throws Error kLimit above 2 GB,
// which is more than one block may hold. Cost: O(#bytes).
Bytes encodeLz4Block(ByteSpan bytes);

}  // namespace limber
