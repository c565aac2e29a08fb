// Which triangles of which primitive belong to which part.
#pragma once

#include <vector>

#include "limber/actions/parts/fuzzy_cut.h"
#include "limber/document/scene/geometry.h"

namespace limber {

// The triangles of one primitive, as one node shows it, that belong to one part; corners are numbers of the primitive's
// own vertices, wound as the file has them.
struct PartTriangles {
  Index part = 0;
  std::vector<Triangle> triangles;
};

// For each of geometry.instances its parts, ascending.
std::vector<std::vector<PartTriangles>> partTriangles(const Geometry& geometry, const SurfaceParts& parts);

// A new index accessor for these triangles, as narrow as the vertices allow.
Index addTriangleAccessor(Asset& asset, const std::vector<Triangle>& triangles, Index vertexCount);

}  // namespace limber
