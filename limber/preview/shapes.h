// The solids that handles and bones are drawn as.
#pragma once

#include <vector>

#include "limber/core/types.h"

namespace limber {

// Triangles with a normal and a colour (linear RGB) at each vertex; vertices are not shared across creases.
struct ShapeMesh {
  std::vector<Vec3f> positions, normals, colors;
  std::vector<Triangle> triangles;
};

void addSphere(ShapeMesh& mesh, const Vec3& center, double radius, const Vec3f& color);

// A cone cut off at both ends, open, from a (radius ra) to b (radius rb). Nothing where a == b.
void addTaperedLink(ShapeMesh& mesh, const Vec3& a, const Vec3& b, double ra, double rb, const Vec3f& color);

// The usual picture of a bone: a thin octahedron, widest near its joint. Nothing where a == b.
void addOctahedralBone(ShapeMesh& mesh, const Vec3& a, const Vec3& b, const Vec3f& color);

}  // namespace limber
