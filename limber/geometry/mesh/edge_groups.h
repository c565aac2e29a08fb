// The sides of a mesh's triangles, grouped by the edge they lie on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Triangle t has the sides 3t, 3t+1, 3t+2; side h runs from its corner to the corner of nextSide(h). Any number of
// sides may lie on one edge, in either direction.
inline Index nextSide(Index side) {
  return side % 3 == 2 ? side - 2 : side + 1;
}

class EdgeGroups {
 public:
  // The triangles stay the caller's and must outlive this. Their vertices are below vertexCount; where two of one
  // triangle are the same, the side between them is an edge of its own (low == high). Cost: O(#F).
  EdgeGroups(std::span<const Triangle> triangles, Index vertexCount);

  // Calls visit(std::span<const Index> sides) for each edge, by lower and then by higher vertex; sides ascend.
  template <class Visit>
  void forEachEdge(const Visit& visit) const {
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
      const Index vertexLow = low(sides_[begin]), vertexHigh = high(sides_[begin]);
      while (end < sides_.size() && high(sides_[end]) == vertexHigh && low(sides_[end]) == vertexLow) ++end;
      visit(std::span<const Index>(sides_.data() + begin, end - begin));
    }
  }

  Index corner(Index side) const { return triangles_[side / 3][side % 3]; }
  Index low(Index side) const { return std::min(corner(side), corner(nextSide(side))); }
  Index high(Index side) const { return std::max(corner(side), corner(nextSide(side))); }
  bool ascends(Index side) const { return corner(side) < corner(nextSide(side)); }  // runs from low to high

 private:
  std::span<const Triangle> triangles_;
  std::vector<Index> sides_;
};

}  // namespace limber
