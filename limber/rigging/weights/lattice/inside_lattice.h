// The inside of a mesh as nodes of a regular grid.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/mesh/winding_number.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// What lattices of a mesh are made from.
struct InsideQueries {
  explicit InsideQueries(const TriMesh& mesh);

  std::unique_ptr<Bvh> surface;
  std::unique_ptr<WindingNumber> winding;  // of pieces that are stored inside out, too
};

// The nodes of a grid that lie inside a mesh, or so near to its surface that this passes through their cells; and those
// that bones pass through, wherever they are. Cells are numbered along x, then y, then z; those of bones outside come
// last, in the order in which they were added. Cost: O(nodes near the surface) queries of both
// trees, in parallel.
class InsideLattice {
 public:
  static constexpr Index kMinCells = 8, kMaxCells = 512;  // along the longest side

  // resolution  cells along the longest side of modelBox, which the grid fills, kMinCells to kMaxCells
  // Throws Error kBadArgument for others, and for a mesh without triangles.
  InsideLattice(const TriMesh& mesh, const InsideQueries& queries, Index resolution);

  double spacing() const { return spacing_; }
  Index cellCount() const { return static_cast<Index>(nodes_.size()); }

  Vec3 position(Index cell) const;

  // A step of -1, 0 or 1 along each axis, for neighbor().
  std::ptrdiff_t step(int x, int y, int z) const { return x + row_ * (y + static_cast<std::ptrdiff_t>(size_[1]) * z); }
  // kNoIndex where nothing is inside.
  Index neighbor(Index cell, std::ptrdiff_t step) const {
    return cellOf_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(nodes_[cell]) + step)];
  }

  // The cells at samples half a spacing apart along a bone, and all inside its ball; those outside the lattice are
  // added to it. Samples beyond the grid have none. In order, and a cell as often as there are samples in it.
  std::vector<Index> cellsAlong(const Bone& bone);

  // The cells among the eight nodes round a position, and their weights in linear interpolation. Returns how many.
  int cellsRound(const Vec3& point, std::array<Index, 8>& cells, std::array<double, 8>& parts) const;

 private:
  std::size_t nodeAt(Index x, Index y, Index z) const { return (std::size_t{z} * size_[1] + y) * size_[0] + x; }
  void addCellAt(const Vec3& point, std::vector<Index>& cells);

  Vec3 origin_ = Vec3::Zero();
  double spacing_ = 1;
  std::array<Index, 3> size_ = {};  // nodes along each axis; the outermost are never inside
  std::ptrdiff_t row_ = 0;
  std::vector<Index> cellOf_;       // by node
  std::vector<std::size_t> nodes_;  // by cell
};

}  // namespace limber
