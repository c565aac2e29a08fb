// The dual graph of a surface: its triangles, and how far and how sharp it is from each to its neighbours.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "limber/core/grouped.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// Between two triangles that share an edge, or that link two pieces.
struct FaceArc {
  Index a = 0, b = 0;   // triangles, a != b
  double distance = 0;  // for clustering: along the surface and round its bends (see FaceGraph)
  double capacity = 0;  // for cutting: the edge's length, less in a bend; 0 for links
  double length = 0;    // of the shared edge; 0 for links
  bool isLink = false;
};

// Arcs as in Katz, Tal 2003, Hierarchical mesh decomposition using fuzzy clustering and cuts, section 3: with the path
// length between the triangles' centroids over the shared edge (geo) and ang = eta (1 - cos of the angle between the
// normals), eta = 1 where the surface is concave and little where it is convex,
//     distance = delta geo / mean(geo) + (1 - delta) ang / mean(ang)
//     capacity = length / mean(length) / (1 + ang / mean(ang))
// The length is ours: cuts are short in metres, however the surface is triangulated. An edge with more than two
// triangles joins each to the next. Pieces that meet in a vertex alone are linked there, others where they
// are nearest (pieceLinks), each link as one sharp concave edge, so that the graph is connected.
struct FaceGraph {
  std::vector<double> areas;  // #F
  std::vector<FaceArc> arcs;  // ordered by shared edge, links last
  Grouped<Index> arcsAt;      // by triangle, numbers of arcs, ascending

  Index faceCount() const { return static_cast<Index>(areas.size()); }
  Index across(Index arc, Index face) const { return arcs[arc].a == face ? arcs[arc].b : arcs[arc].a; }
};

// mesh  any, each triangle with three different vertices (prepareMesh); triangles of either orientation
// Cost: O(#F), and pieceLinks.
FaceGraph faceGraph(const TriMesh& mesh);

// Makes `distances` (#F) the shortest that lead on from the sources, whose own are set, wherever that is less than what
// is there (Dijkstra); tells each time from where a triangle is reached. Cost: O(n log n) in the triangles reached.
void shortenFrom(const FaceGraph& graph, std::span<const Index> sources, std::vector<double>& distances,
                 const std::function<void(Index from, Index to)>& reach);

// Shortest distances from one triangle to all others. Cost: O(#F log #F).
std::vector<double> distancesFrom(const FaceGraph& graph, Index face);

}  // namespace limber
