// The surface of a model's geometry that riggers and methods of weights read.
#pragma once

#include <span>

#include "limber/document/scene/geometry.h"
#include "limber/geometry/surface/figure_surface.h"

namespace limber {

// figureSurface of the geometry: where its instances meet, vertices are welded as exactly as their numbers are known.
// triangles  geometry.triangles, or some of them
inline FigureSurface figureOf(const Geometry& geometry, std::span<const Triangle> triangles) {
  return figureSurface(geometry.positions, triangles, storedVertices(geometry));
}

// removeRig, and how much of the asset that was.
struct RemovedRig {
  Index joints = 0, clips = 0;
};
RemovedRig takeRigOut(Asset& asset);

}  // namespace limber
