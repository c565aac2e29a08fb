// Weights of what is in a model but no part of the surface that was rigged.
#pragma once

#include <vector>

#include "limber/geometry/surface/figure_surface.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// For each vertex of surface.innerShell the vertex of the surface that it is a copy of, else the one nearest to it.
// Cost: O(#F log #F) where there is an inner shell.
std::vector<Index> outerVertices(const FigureSurface& surface);

// Has inner shells take the weights of the vertices of the surface that they are copies of (outerVertices), and
// surroundings follow joint 0, the root.
//
// weights  of surface.prepared.mesh
// Cost: that of outerVertices.
void bindLeftOut(const FigureSurface& surface, SkinWeights& weights);

}  // namespace limber
