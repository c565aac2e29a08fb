// FBX files as glTF documents.
#pragma once

#include "limber/document/read.h"

namespace limber {

// A file of version 7.x, binary or text: models with their whole transform, meshes with normals, texture coordinates,
// colours and materials, skins with their bind pose, blend shapes, clips. In metres and +Y up; where the file has other
// units or directions with a warning "converted-units" or "converted-axes". A skinned mesh becomes a node at the root,
// its vertices in the world as they were bound.
//
// What does not come along is a warning: lights, cameras, constraints, curves and surfaces that are no polygons
// ("other-geometry"), caches of points, other layers of clips than the first, textures that are missing or neither PNG
// nor JPEG or of other properties than colour, normals and emission ("other-textures"). Pictures are opened through
// `resolver` only.
//
// Throws Error kBadData for a broken file or one with a position that is not finite, kUnsupported for other versions,
// kLimit where its meshes would hold far more than those of a file of its size (FbxBudget).
// The result has not passed checkAsset yet.
Asset importFbx(ByteSpan bytes, const Resolver& resolver);

}  // namespace limber
