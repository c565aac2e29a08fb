// Where heat enters the surface: for each vertex its nearest bones in sight, and how strongly they hold it.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

struct HeatSourceOptions {
  double heat = 4;             // c of the paper (there 1): larger keeps weights closer to the bones
  bool facing = true;          // a bone in front of the surface rather than behind it counts as farther away
  double tieTolerance = 1e-4;  // bones farther than the nearest by less than this part of its distance share the vertex
  double minDistance = 5e-5;   // vertices nearer to a bone count as so far, in longest sides of the model
};

// For vertex v the joints first[v] to first[v + 1] of `joints`, ascending and different, each pull with `pull[v]`,
// which is c / d^2 where d is the distance to the nearest bone's axis. With `facing`, distances are divided by (1 +
// cos) / 2 of the angle between the direction from the bone and the outward normal: the inner side of a thigh is not
// bound to the other leg's bone, however near that is. A vertex that sees no bone has none and pull 0.
struct HeatSources {
  std::vector<double> pull;   // #V
  std::vector<Index> first;   // #V + 1
  std::vector<Index> joints;  // at most a few for each vertex

  std::span<const Index> jointsOf(Index v) const { return {joints.data() + first[v], first[v + 1] - first[v]}; }
};

// The nearest bone is the one whose surface (the points at its radius) is nearest. It is in sight when the segment from
// the vertex to that surface passes through no triangle.
//
// Where it is known which joint's region of the surface a vertex is of, the bones of that joint are in sight of it, and
// the surfaces of other bones count as farther away by the distance to their axes: a leg does not hold the other one,
// and a joint keeps a region that is small or far from it.
//
// bvh      over the whole mesh; null: every bone is in sight
// jointOf  #V; empty: not known
// Cost: O(#V #B) for distances and O(#V log #F) for sight, in parallel.
HeatSources findHeatSources(const TriMesh& mesh, std::span<const Bone> bones, const Bvh* bvh,
                            const HeatSourceOptions& options, std::span<const Index> jointOf = {});

}  // namespace limber
