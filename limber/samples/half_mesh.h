// The surface of a Sculpture as even triangles: one half is made and then mirrored, so that symmetry is exact.
#pragma once

#include <vector>

#include "limber/samples/sculpture.h"

namespace limber {

// The half x >= 0. Vertices with x == 0 are the seam.
struct HalfMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<int> materials;  // one for each triangle
};

// Surface nets over cubes of that size, centred on the plane of symmetry; then relaxed on the surface. What is
// thinner than about two cubes gets holes.
HalfMesh polygonize(const Sculpture& sculpture, double cube);

// Vertices drawn to the mean of their neighbours along the surface, and back onto it.
void relax(HalfMesh& mesh, const Sculpture& sculpture, int rounds);

// Where triangles are smaller than elsewhere.
struct DetailRegion {
  Solid where;
  double edge = 0;  // wanted length, metres
};

// Splits long edges and merges the ends of short ones until all are about `edge` long (in the regions: what they want),
// with flips to Delaunay and relaxation in between (after Botsch, Kobbelt 2004).
void remesh(HalfMesh& mesh, const Sculpture& sculpture, double edge, const std::vector<DetailRegion>& regions);

// Triangles inside `region` get that material; edges are laid along the region's border first, so that it is sharp.
void paint(HalfMesh& mesh, const Sculpture& sculpture, const Solid& region, int material);

// Both halves.
struct SymmetricMesh {
  std::vector<Vec3f> positions, normals;
  std::vector<Triangle> triangles;
  std::vector<int> materials;
};
SymmetricMesh mirrorHalf(const HalfMesh& half, const Sculpture& sculpture);

}  // namespace limber
