// The ends of limbs on a graph of spheres, as a tree of handles should reach them.
#pragma once

#include <vector>

#include "limber/core/types.h"
#include "limber/rigging/sphere_mesh/collapse_graph.h"

namespace limber {

// Spheres and their neighbours, where the model's longest side is 1. A pair (not `single`) stands for a sphere and its
// image in the plane x = 0.
struct SphereGraph {
  std::vector<Vec3f> centers;
  std::vector<double> areas;         // of the surface that each represents, of one of a pair
  std::vector<std::uint8_t> single;  // as in CollapseInput
  std::vector<GraphEdge> edges;      // likewise
};

struct LimbEnd {
  double length = 0;         // of what stands out, from its end to where it joins something longer
  double ownLength = 0;      // to where another limb joins it that is at least half as long, if one does
  double thickness = 0;      // of the outer three quarters of that: the diameter of a cylinder of their length and area
  bool isOnPlane = false;    // one limb with both of its sides, such as a tail; else it stands for its image too
  std::vector<Index> nodes;  // of its outer half, as far as it is its own
};

// What stands out: the parts of the surface that are farther from all of it than what is around them. Height over the
// surface is the mean distance along it to nodes that are far from each other (the average geodesic distance of Hilaga,
// Shinagawa, Kohmura, Kunii: Topology Matching, 2001); ends are its maxima, and each reaches down to where its part
// meets that of a higher maximum (persistence; Edelsbrunner, Letscher, Zomorodian 2002). Only such as are longer than
// they are thick, and not as thin as specks; the longest first.
//
// graph  connected
// Cost: O(#E log #N), sixteen times.
std::vector<LimbEnd> limbEnds(const SphereGraph& graph);

}  // namespace limber
