// From a file's vertices to the mesh that the engine works on, and back.
#pragma once

#include <span>
#include <vector>

#include "limber/core/error.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/mesh/weld.h"

namespace limber {

// p_source = scale * p_working + offset
struct WorkingFrame {
  double scale = 1;
  Vec3 offset = Vec3::Zero();

  Vec3 toSource(const Vec3& working) const { return scale * working + offset; }
  Vec3 toWorking(const Vec3& source) const { return (source - offset) / scale; }
};

struct PreparedMesh {
  TriMesh mesh;                     // welded, centred, longest side of modelBox 1, no degenerate triangle
  std::vector<Index> weldedVertex;  // source vertex -> vertex of mesh; defined for every source vertex
  WorkingFrame frame;
  Warnings warnings;  // kinds: degenerate-triangles, far-vertices
};

// Welds vertices that are one point (samePoints), leaves out triangles that have a repeated vertex after welding
// (zero-area triangles with three different vertices stay), centres and scales. A welded vertex has the position of the
// lowest source vertex. Far pieces (modelBox) and loose vertices lie outside the unit box, at most 1e4 from its middle;
// far-vertices counts what lies outside of modelBox: of loose vertices those more than kFarAway away.
//
// positions  #S source vertices in world space, finite
// triangles  indices into positions, in range
// stored     how exactly the positions are known, as for samePoints
// Throws Error kBadData where no triangle is left ("has no triangle"), and kBadArgument for an index out of range.
// Cost: that of samePoints.
PreparedMesh prepareMesh(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                         std::span<const StoredVertices> stored = {});

}  // namespace limber
