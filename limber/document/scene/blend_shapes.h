// The blend shapes (morph targets) of an Asset, over all of its vertices, and put into another one.
#pragma once

#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/scene/geometry.h"

namespace limber {

struct BlendShape {
  std::string name;            // "shape_3" where the file gives none
  std::vector<Vec3f> offsets;  // #S of Geometry, world space
};

// Shapes of one name are one, whichever meshes have them. geometry = collectGeometry(asset)
std::vector<BlendShape> readBlendShapes(const Asset& asset, const Geometry& geometry);

// Adds them to every mesh that they move and that has none of its own; the others stay as they are. Offsets smaller
// than a millionth of the model's box count as none. Returns the names of the shapes that were added.
std::vector<std::string> addBlendShapes(Asset& asset, const Geometry& geometry, const std::vector<BlendShape>& shapes);

}  // namespace limber
