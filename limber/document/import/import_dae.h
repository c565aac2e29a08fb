// What Assimp reads wrongly in the text of a COLLADA file.
#pragma once

#include <cstddef>
#include <string>

#include "limber/core/file/file.h"

namespace limber {

struct DaeText {
  std::string text;                // for Assimp
  std::size_t curvedSamplers = 0;  // with keys of another interpolation than LINEAR, which Assimp does not heed
};

// The file without the white space at the ends of the texts between its tags: before numbers Assimp reads it as a zero
// ("vcount"), as no number ("color") or not at all ("v"). Cost: one pass over the text. Throws Error kUnsupported for
// UTF-16.
DaeText prepareDae(ByteSpan bytes);

}  // namespace limber
