// Colours of a model's vertices, instead of those it had.
#pragma once

#include <functional>
#include <set>
#include <span>

#include "limber/document/asset.h"
#include "limber/document/scene/geometry.h"

namespace limber {

// The colour of a surface, linear RGB in [0, 1], at a triangle of its Geometry by the weights of its three corners.
using SurfaceColor = std::function<Vec3f(Index triangle, const Vec3& weights)>;

// Gives every primitive that the scene shows these colours as COLOR_0. Its material keeps all but what they would be
// multiplied by: the base colour becomes white, the base colour texture goes. One that has no material gets a plain
// one.
//
// geometry  of the asset (collectGeometry)
// colors    #S linear RGB in [0, 1]
// pictured  materials whose colours a texture will give: only made ready, and COLOR_0 goes
void setVertexColors(Asset& asset, const Geometry& geometry, std::span<const Vec3f> colors,
                     const std::set<Index>& pictured = {});

// Every primitive that the scene shows and that has no material gets a plain white one, all the same.
void addMissingMaterials(Asset& asset, const Geometry& geometry);

}  // namespace limber
