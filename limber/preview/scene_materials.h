// Base colour textures and transparency of an asset, made ready for drawing.
#pragma once

#include <vector>

#include "limber/document/scene/geometry.h"
#include "limber/preview/scene.h"

namespace limber {

// Fills scene.uvs, materialOf and materials from the materials of the geometry's instances; scene.triangles must be
// those of the geometry. Follows wrap modes, the choice of texture coordinates, and KHR_texture_transform. Images that
// cannot be drawn (see decodeImage) are counted in the warning "undrawn-textures". Returns for each instance whether it
// has a texture now.
std::vector<bool> addMaterials(const Asset& asset, const Geometry& geometry, Scene& scene);

}  // namespace limber
