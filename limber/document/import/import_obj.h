// What Assimp reads wrongly, or does not tell, of OBJ files and their materials.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "limber/core/file/file.h"
#include "limber/document/mesh/obj_lines.h"

namespace limber {

// A vertex' number as two of a colour's digits, which both are exact in single precision.
inline constexpr std::size_t kObjNumberBase = 65536;

// The number that such a colour says, of `count` vertices; none where it says none of theirs.
inline std::optional<std::size_t> objNumber(float red, float green, std::size_t count) {
  const double number = double{red} + double{kObjNumberBase} * green;
  if (!(number >= 0 && number < static_cast<double>(count))) return std::nullopt;  // NaN neither
  return static_cast<std::size_t>(number);
}

// What becomes of the numbers that an OBJ file gives its vertices.
enum class ObjNumbers { kDropped, kKept };

struct ObjText {
  // For Assimp: without the faces that are counted below, with each element on one line and no number that counts
  // backwards. Each vertex has a colour that says its number in the file: n is
  // (n % kObjNumberBase, n / kObjNumberBase, 0).
  std::string text;
  std::vector<std::array<float, 4>> colors;  // #v, as the file has them, NaN where it has none; empty: none has any
  // "v" lines that no "f", "l" or "p" line names: Assimp leaves these vertices out. 0 where none is named at all (a
  // cloud of points).
  std::size_t looseVertices = 0;
  std::size_t invalidFaces = 0;  // that name what is not there
};

// Colours are three or four numbers after a vertex's position; alpha is 1 where it is not given. Throws Error kBadData
// where all faces refer to missing vertices, kLimit where objects, groups or materials change too often. Cost: two
// passes over the text.
ObjText prepareObj(ByteSpan bytes);

// How many textures of an MTL file are moved or scaled (-o, -s, -t).
std::size_t countMovedMtlTextures(ByteSpan bytes);

}  // namespace limber
