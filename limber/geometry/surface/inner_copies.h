// Copies of all components of a surface a little within them, as image-to-3D generators leave them.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/surface/surface_component.h"

namespace limber {

struct InnerCopy {
  std::size_t outer = 0, inner = 0;  // components
  bool isVertexByVertex = false;     // the k-th vertex of one is a copy of the other's k-th
};

// The components in pairs of an outer and an inner one, where nearly all of the surface is in such pairs; else nothing.
// No component is in two pairs. A component may be open, and the copy of a thin one may come out of it.
//
// Two components are a pair where their boxes nearly agree and either their triangles join the same vertices, one
// moved as far as the other, or each lies all along the other. The inner one of a pair is the one that fewer rays from
// the outside reach; where nearly all copies are stored after (before) what they are copies of, so are all.
//
// components  SurfaceComponents::list, or some of it in that order
// Cost: O(#components) boxes each, at most 1000 components; O(#F log #F) where most of the surface may be in pairs.
std::vector<InnerCopy> innerCopies(const TriMesh& mesh, std::span<const SurfaceComponent> components);

}  // namespace limber
