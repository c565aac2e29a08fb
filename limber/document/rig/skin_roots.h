// glTF asks that the joints of a skin have a node above them all.
#pragma once

#include "limber/document/gltf/gltf.h"
#include "limber/document/unique_names.h"

namespace limber {

// Where the joints of a skin lie below several roots of the nodes' tree, adds one node without a transform for all
// skins as the parent of these roots, replacing them in the default scene. Its name is new among `names`.
void joinSkinRoots(gltf::Document& document, UniqueNames& names);

}  // namespace limber
