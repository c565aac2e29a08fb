// The connected components of a surface: what each is made of, how large it is, samples of it.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

struct SurfaceComponent {
  std::span<const Index> vertices, triangles;  // ascending
  Box box;
  double area = 0;
};

// Numbers 0, 1, ... ordered by the group that each belongs to; the first of group g is at begin[g].
struct Grouped {
  std::vector<Index> members;
  std::vector<std::size_t> begin;

  Grouped(std::span<const Index> groupOf, Index groupCount);
  std::span<const Index> of(Index group) const {
    return std::span(members).subspan(begin[group], begin[group + 1] - begin[group]);
  }
};

// Those that have triangles, the one of the largest box first. Cost: O(#V + #F).
struct SurfaceComponents {
  Grouped vertices, triangles;
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
