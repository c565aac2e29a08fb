// The one surface of a model that riggers and methods of weights read.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/prepare.h"

namespace limber {

struct FigureSurface {
  PreparedMesh prepared;               // without the triangles of what follows, whose vertices are loose in it
  std::vector<Index> innerShell;       // vertices of prepared.mesh, ascending
  std::vector<Index> innerShellOuter;  // for each the vertex that it is a copy of, or kNoIndex
  std::vector<Index> surroundings;     // vertices of prepared.mesh, ascending
};

// prepareMesh, with each face once, faces that agree about the outside (mendFaces), and without
// - the surroundings: connected components that are no part of the figure. These are flat ones that reach beyond all of
//   it on every side, which it rests on or is in front of (floors, walls, slabs), closed convex ones round all of it
//   (collider boxes), and flat or convex ones that its feet rest on (the steps of a pedestal; +Y up). The object that
//   they surround has to be a figure: thick along a floor's normal, and hollow, so that it fills less than half of its
//   box;
// - inner shells: copies of all components a little within them (innerCopies); and components of which most lies within
//   another one and which are, almost everywhere near its surface, a copy of it; where most of the figure has one, also
//   small components within what has one.
// The model's size, and so PreparedMesh::frame, is that of the figure.
//
// prepared.warnings has the kinds repeated-faces, reversed-faces, inner-shell and surroundings, too, which count
// triangles. Errors of prepareMesh. Cost: O(#F) for a mesh of one component whose neighbours agree; else that of
// mendFaces, and O(#F log #F) where a component may be a shell within another one.
FigureSurface figureSurface(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                            std::span<const StoredVertices> stored = {});

}  // namespace limber
