// What Assimp reads wrongly, or does not tell, of OBJ files and their materials.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "limber/core/file.h"

namespace limber {

struct ObjText {
  // For Assimp: without the faces that are counted below, with each element on one line. Where vertices have colours
  // all have one, which says their number: n is (n % kObjColorBase, n / kObjColorBase, 0).
  std::string text;
  std::vector<std::array<float, 4>> colors;  // #v, as the file has them, NaN where it has none; empty: none has any
  // "v" lines that no "f", "l" or "p" line names: Assimp leaves these vertices out. 0 where none is named at all (a
  // cloud of points).
  std::size_t looseVertices = 0;
  std::size_t invalidFaces = 0;  // that name what is not there
};

inline constexpr std::size_t kObjColorBase = 65536;

// Colours are three or four numbers behind a vertex' place; alpha is 1 where it is not given. Throws Error kBadData
// where all faces name what is not there. Cost: two passes over the text.
ObjText prepareObj(ByteSpan bytes);

// How many textures of an MTL file are moved or scaled (-o, -s, -t).
std::size_t countMovedMtlTextures(ByteSpan bytes);

}  // namespace limber
