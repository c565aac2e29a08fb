// PLY files as glTF documents.
#pragma once

#include "limber/document/read.h"

namespace limber {

// Starts as a PLY file does.
bool looksLikePly(ByteSpan bytes);

// Text and binary files in either order of bytes (Turk: The PLY Polygon File Format, 1994): vertices with normals,
// colours (of integers: 255 or 65535 is 1; taken as sRGB, as three.js and Blender do) and texture coordinates;
// polygons, also with texture coordinates of their own for each corner, and strips of triangles. The picture that a
// "comment TextureFile" names is embedded. Other elements and properties are left out, the first with a warning
// "other-elements". Polygons are triangulated, equal vertices joined (addPlainMesh).
//
// Throws Error kBadData where the header has no end, or less or other data follows than it announces. Cost: linear in
// the file; memory a few times its size, whatever it announces.
Asset readPly(ByteSpan bytes, const Resolver& resolver);

}  // namespace limber
