// The vertices of an OBJ file by the numbers that the file gives them.
#pragma once

#include <string_view>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/read.h"

namespace limber {

struct ObjVertices {
  std::vector<Vec3f> positions;  // #V, of the "v" lines in their order
  std::vector<Index> corners;    // of the faces, one behind the other: vertices from 0, kNoIndex behind each face
};

// Texture coordinates and normals, which may be numbered otherwise in files of one mesh, are passed over. Throws Error
// kBadData, with `name` as where, for a vertex that is not three finite numbers and a face that names a vertex that is
// not there; kLimit beyond 2^32-2 vertices. Cost: one pass; memory within a few times the text.
ObjVertices readObjVertices(ByteSpan bytes, std::string_view name);

struct ObjModel {
  Asset asset;
  ObjVertices vertices;
  std::vector<Index> vertexOf;  // #S vertices of collectGeometry(asset): their numbers in the file, from 0
};

// The file as readAsset gives it, except that vertices with different numbers stay separate where their positions are
// equal. Throws as readObjVertices and readAsset do.
ObjModel readObjModel(ByteSpan bytes, std::string_view name, const Resolver& resolver);

}  // namespace limber
