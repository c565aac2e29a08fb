// One surface deformed onto another.
#pragma once

#include <span>
#include <vector>

#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/surface/surface_edges.h"

namespace limber {

struct RegistrationOptions {
  // Lengths over which a pull at one point of the surface spreads, from coarse to fine; parts of the target's longest
  // side.
  std::vector<double> reaches = {0.2, 0.1, 0.05, 0.025, 0.0125};
  int rounds = 4;  // of correspondences and solves at each reach, 1 or more
};

// Where the vertices of `source` are once it lies on `target`: #V of the source.
//
// Non-rigid iterative closest points, as Sumner and Popović (2004) and Amberg, Romdhani, Vetter (2007) do it: in turn
// each vertex is given a goal, and the surface follows as far as its stiffness lets it (ElasticSurface); the stiffness
// falls from round to round. A vertex's goal is the nearest point of the target that faces about its own direction and
// is not too far, and points of the target pull what of the source is nearest to them likewise, so that it is covered.
// What finds no goal goes along with its neighbours.
//
// source, target  facing outwards (facingOutwards), with triangles; lying in each other, limb on limb
// links           pairs of source vertices that hold its pieces together (pieceLinks)
// Cost: for each round a factorisation over the source and O((#V + #T) log #F) nearest points, of at most 20000 of the
// target's vertices.
std::vector<Vec3> registerSurface(const TriMesh& source, std::span<const VertexPair> links, const TriMesh& target,
                                  const RegistrationOptions& options, Progress& progress);

}  // namespace limber
