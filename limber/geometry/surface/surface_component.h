// The connected components of a surface: what each is made of, how large it is, samples of it.
#pragma once

#include <span>
#include <vector>

#include "limber/core/grouped.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

struct SurfaceComponent {
  std::span<const Index> vertices, triangles;  // ascending
  Box box;
  double area = 0;
};

// Those that have triangles, the one of the largest box first. Cost: O(#V + #F).
struct SurfaceComponents {
  Grouped<Index> vertices, triangles;
  std::vector<SurfaceComponent> list;

  static SurfaceComponents of(const TriMesh& mesh);
};

struct AreaSample {
  Vec3 position;
  double area;
};

// The middles of at most `count` evenly chosen triangles of a component.
std::vector<AreaSample> areaSamplesOf(const TriMesh& mesh, const SurfaceComponent& component, std::size_t count = 200);

}  // namespace limber
