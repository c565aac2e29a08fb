// From a contracted surface, still made of triangles, to curves.
#pragma once

#include <vector>

#include "limber/rigging/curve_skeleton/even_surface.h"

namespace limber {

// nodeOf  #P: the node that each point of the surface went into, numbered in the order of their lowest points
// edges   between nodes, ordered, none twice
struct CurveGraph {
  std::vector<Index> nodeOf;
  Index nodeCount = 0;
  std::vector<VertexPair> edges;
};

// Half-edges of triangles are collapsed, cheapest first, until no triangle is left (Au et al. 2008, section 5): what a
// collapse costs is how far the kept point lies from the lines of all edges that it represents (shape), and a tenth of
// its length times that of the edges it draws along (sampling), so that nodes stay spread along the curves. Loops of
// the surface stay loops. A point on the mirror plane is never collapsed into one beside it, so that the two halves of
// a mirrored model stay connected.
//
// contracted  #P, the surface's points after the contraction
// Cost: O(#P log #P).
CurveGraph curveGraph(const EvenSurface& surface, const std::vector<Vec3>& contracted);

// Where a node's part of the surface lies: its middle, and the mean distance from there.
struct NodePlacement {
  Vec3 point = Vec3::Zero();
  double radius = 0;
  double area = 0;
  bool isPaired = false;  // of a half: has an image
};
std::vector<NodePlacement> nodePlacements(const EvenSurface& surface, const CurveGraph& graph);

// Branches that end before they leave the body, such as collapses leave at blunt ends, go into the node that they come
// off: those whose end lies within the radius that both have together. The shortest first. Cost: O(#P) for each branch
// that is tried.
void absorbStubs(const EvenSurface& surface, CurveGraph& graph);

}  // namespace limber
