// Weights of what is in a model but no part of the surface that was rigged.
#pragma once

#include "limber/skeleton/skin_weights.h"
#include "limber/surface/figure_surface.h"

namespace limber {

// Has inner shells take the weights of the vertices of the surface that are nearest to them, and surroundings follow
// joint 0, the root.
// weights  of surface.prepared.mesh
// Cost: O(#F log #F) where there is an inner shell.
void bindLeftOut(const FigureSurface& surface, SkinWeights& weights);

}  // namespace limber
