// Which vertices of a file are one point, though rounding has moved them apart.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// Consecutive vertices that were stored alike, as those of one primitive are, and how exactly. In the positions' unit.
struct StoredVertices {
  Index first = 0, count = 0;
  Vec3 origin = Vec3::Zero();  // where 0 of the stored numbers lies: they were rounded as their distance from it is
  double quantisation = 0;     // the largest distance that the file's grid moved a vertex by, 0 where there is no grid
};

// Returns #V representatives: the lowest vertex of the same point. A representative represents itself.
//
// Equal positions (bit for bit, -0 equal to 0) are one point. So are vertices that are no farther apart than rounding
// explains: 2^-20 of the model's longest side (modelBox), and for either vertex 2^-22 of its largest coordinate, as it
// is and seen from the origin of its range; at most 1/16 of the median edge of either range. A vertex joins the nearest
// representative before it, so that a chain of near vertices does not become one.
//
// A grid is much coarser than that. Vertices of one range lie on one grid. Those of two ranges of which one has a grid
// at least join where open edges meet along a seam: each joins the nearest of the other range, no farther away than the
// `quantisation` of both explains, at most the median edge. So two of one range become one where a coarser grid has
// made one of their counterparts. A match counts if an open edge leads from both ends to another match, or from one end
// to a match of the other that counts. Two ranges that meet at as many points without this have a grid in common and
// stay as they are.
//
// positions  #V, finite
// triangles  indices in range
// stored     by ascending `first`, not overlapping, in range; other vertices are a range without a grid
// Cost: O(#V + #F), with hash tables; the edges are sorted where there are grids.
std::vector<Index> samePoints(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                              std::span<const StoredVertices> stored = {});

}  // namespace limber
