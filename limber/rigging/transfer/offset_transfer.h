// Offsets of a surface's vertices, such as blend shapes are made of, carried to another surface.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/bvh.h"

namespace limber {

// #V, how the surface round each vertex was deformed: the deformation gradients of the triangles (their edges and their
// normal, whose length goes with the root of the area: Sumner, Popović 2004, equations 1 to 3), their mean by area. The
// identity where a vertex has no triangle with an area. Under a rotation each is that rotation, under a scale that
// scale.
std::vector<Mat3> deformationGradients(const TriMesh& before, std::span<const Vec3> after);

// #points offsets: those of the triangle's corners, each taken along by its vertex's gradient, mixed by the point's
// barycentric weights.
std::vector<Vec3f> carriedOffsets(const TriMesh& source, std::span<const Mat3> gradients,
                                  std::span<const Vec3f> offsets, std::span<const SurfacePoint> points);

}  // namespace limber
