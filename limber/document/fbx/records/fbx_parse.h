// The bytes of an FBX file as its records.
#pragma once

#include "limber/document/fbx/records/fbx_node.h"

namespace limber {

struct FbxFile {
  std::uint32_t version = 0;  // 7400: FBX 7.4
  FbxNode root;               // nameless; its children are the file's records: Objects, Connections, ...
};

// By the first bytes: binary, or text with a comment or a record that only FBX begins with.
bool looksLikeFbx(ByteSpan bytes);

// Versions 7.0 and later, binary (32 bit offsets before 7.5, 64 bit since) or as text.
//
// Text has no types: a whole number is an int64, another a double, a word without quotes (T, Shading) a string; an
// array ("*3 { a: 1,2,3 }") is a vector of int64 where all are whole, else of double. In quoted text &quot; is a quote.
//
// Throws Error kUnsupported for versions before 7.0 and big-endian files, kBadData (with the byte offset) for what is
// broken, kLimit where arrays inflate to far more than any file of that size would. Records are at most 64 deep; memory
// is bounded by the file's size. Cost: linear.
FbxFile parseFbx(ByteSpan bytes);

}  // namespace limber
