// The caps that close parts where they are cut off the rest.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// One cap: a simple loop of the cut, filled.
struct PartCap {
  std::vector<Index> loop;          // vertices of the mesh, counter-clockwise seen from outside the part
  std::vector<Triangle> triangles;  // numbers in `loop`; loop.size() is a new vertex in the loop's middle
  bool hasMiddle = false;
  Vec3 normal = Vec3::Zero();  // outwards, unit length; zero where the loop encloses nothing
};

struct PartCaps {
  std::vector<std::vector<PartCap>> capsOf;  // #P, in the order of their lowest edges
  std::size_t openEdges = 0;                 // edges of cuts that end at an open edge of the surface, or run astray
};

// For each part the loops of edges along which other parts go on, each filled by ear clipping in the plane that fits
// it, shortest diagonals first, and never with an edge that the part has already: else by a fan round its middle. A
// part of a closed surface is closed by its caps, each edge having two triangles as before. Loops in one plane are
// filled one by one, so that a cut through a hollow wall has two caps, one over the other.
//
// mesh  each triangle with three different vertices; the triangles at each cut have to face alike, or the cut counts
//       as open
// Throws Error kCancelled. Cost: O(#F log #F + the sum of loops' lengths squared).
PartCaps capParts(const TriMesh& mesh, std::span<const Index> partOf, Index partCount, Progress& progress);

}  // namespace limber
