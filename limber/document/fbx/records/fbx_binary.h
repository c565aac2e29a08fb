// Binary FBX files; parseFbx is what others call.
#pragma once

#include <string_view>

#include "limber/document/fbx/records/fbx_parse.h"

namespace limber {

// A binary file begins with this, and the bytes 0, 0x1a and 0 (little-endian).
inline constexpr std::string_view kFbxMagic = "Kaydara FBX Binary  ";
inline constexpr int kDeepestFbxNode = 64;
inline constexpr std::uint32_t kOldestFbxVersion = 7000;

bool isBinaryFbx(ByteSpan bytes);
FbxFile parseBinaryFbx(ByteSpan bytes);

// Throws Error kUnsupported for a version that is not read.
void checkFbxVersion(std::uint32_t version);

}  // namespace limber
