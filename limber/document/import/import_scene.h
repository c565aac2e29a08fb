// A scene that Assimp has read, as a glTF document.
#pragma once

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/import/import_io.h"

struct aiScene;

namespace limber {

// Node tree, meshes, skins, materials and node animations. Lengths are multiplied by `scale`: positions, translations
// (of nodes, inverse binds and animations); angles and proportions stay. `axes` turns the top of the tree. A skinned
// mesh becomes a node at the root.
Asset convertScene(const aiScene& scene, const ImportIo& io, double scale, const Mat3& axes);

}  // namespace limber
