// Models of other formats, through Assimp, as glTF.
#pragma once

#include <string_view>

#include "limber/document/import/import_obj.h"
#include "limber/document/read.h"

namespace limber {

// An OBJ, STL, OFF or DAE file as a glTF document: node tree, meshes with normals, texture coordinates and colours,
// base colours and textures, skins and node animations. Polygons are triangulated, and equal corners share a vertex.
// The format is detected from the content where that is possible, else from the extension of `name`.
//
// Converted to metres and +Y up where the file says what it has (DAE), with a warning "converted-units" or
// "converted-axes". What does not come along (lights, cameras, morph targets, textures that are missing or neither PNG
// nor JPEG) is a warning too. Textures and material libraries are opened through `resolver` only.
//
// Throws Error kBadData ("cannot be read as OBJ: ...") for a broken file or one with a position that is not finite, and
// kUnsupported for other formats. Assimp runs in a process of its own (import_sandbox.h), so that no file can crash or
// hang this one. The result has not passed checkAsset yet.
//
// kKept numbers the vertices of an OBJ file as readNumberedObj does.
Asset importModel(ByteSpan bytes, std::string_view name, const Resolver& resolver,
                  ObjNumbers numbers = ObjNumbers::kDropped);

}  // namespace limber
