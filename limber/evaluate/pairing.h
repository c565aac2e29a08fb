// Which vertex and which joint of one model is which of another.
#pragma once

#include <vector>

#include "limber/core/types.h"

namespace limber {

struct TriMesh;
struct Skeleton;

// For each vertex of `from` its counterpart in `to`, kNoIndex where there is none within 1e-4 of the diagonal of `to`.
// The vertex at the same index, if that holds for all; else the nearest one, and among those equally near the one whose
// normal is most alike.
struct VertexPairs {
  std::vector<Index> partner;  // #V of `from`
  bool orderKept = false;
};
VertexPairs pairVertices(const TriMesh& from, const TriMesh& to);

// For each joint of `from` its counterpart in `to`: of the same name; where no name at all is shared and the counts are
// equal, of the same index. kNoIndex for the others.
std::vector<Index> pairJoints(const Skeleton& from, const Skeleton& to);

}  // namespace limber
