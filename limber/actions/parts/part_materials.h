// Parts written into a document as materials.
#pragma once

#include <span>

#include "limber/actions/parts/fuzzy_cut.h"
#include "limber/document/scene/geometry.h"

namespace limber {

// Each primitive becomes one for each part that it has triangles of, over the same vertices: attributes, morph targets
// and skins stay. Each part's material is a copy of the one that was there, textures and all, named after the part
// ("leftArm", or "leftArm_cloth" where the part has several).
//
// geometry  collectGeometry(asset) as it is; `parts` one for each of its triangles
// tints     #P, linear RGB, by which the materials' base colours are multiplied; empty: colours stay
// A mesh that several nodes show is copied for each of them. GPU instances of one node go by the first of them, with
// warning "instanced-parts". Triangle strips and fans become triangles. Cost: O(#F), and for each part the materials.
void paintParts(Asset& asset, const Geometry& geometry, const SurfaceParts& parts, std::span<const Vec3f> tints);

}  // namespace limber
