// What Assimp does not tell of an OBJ file.
#pragma once

#include <cstddef>

#include "limber/core/file.h"

namespace limber {

// How many "v" lines no "f", "l" or "p" line names: Assimp leaves these vertices out. 0 where none is named at all (a
// cloud of points). Cost: one pass over the text.
std::size_t countLooseObjVertices(ByteSpan text);

}  // namespace limber
