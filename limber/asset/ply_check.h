// What readers of PLY, Assimp and three.js, do not check.
#pragma once

#include <cstdint>

#include "limber/core/file.h"

namespace limber {

struct PlyCounts {
  std::uint64_t vertices = 0, faces = 0;
};

// The counts that the header announces. Throws Error kBadData where the header has no end (Assimp would look for it
// forever), or where too little follows it for what it announces (they would make the rest up): in a text fewer lines
// than elements, else fewer bytes than its scalars and the lengths of its lists take.
PlyCounts checkPly(ByteSpan file);

}  // namespace limber
