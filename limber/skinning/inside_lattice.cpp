#include "limber/skinning/inside_lattice.h"

#include <algorithm>
#include <cmath>

#include "limber/core/parallel.h"
#include "limber/mesh/signed_distance.h"
#include "limber/mesh/turned_pieces.h"

namespace limber {

namespace {

constexpr double kThroughCell = 0.87;  // spacings: half the diagonal of a cell, which the surface passes through then
constexpr double kPlaceStep = 0.5;     // spacings between places of a bone that are looked at

}  // namespace

InsideQueries::InsideQueries(const TriMesh& mesh) {
  parallelInvoke([&] { surface = std::make_unique<Bvh>(mesh); },
                 [&] { winding = std::make_unique<WindingNumber>(mesh, turnedPieces(mesh)); });
}

InsideLattice::InsideLattice(const TriMesh& mesh, const InsideQueries& queries, Index resolution) {
  const SignedDistance grid(mesh, *queries.surface, *queries.winding, resolution);
  spacing_ = grid.spacing();
  // One node more on every side, so that every cell has all its neighbors.
  origin_ = grid.position(0) - Vec3::Constant(spacing_);
  for (int axis = 0; axis < 3; ++axis) size_[axis] = grid.size()[axis] + 2;
  row_ = size_[0];
  cellOf_.assign(std::size_t{size_[0]} * size_[1] * size_[2], kNoIndex);
  std::size_t from = 0;
  for (Index z = 1; z + 1 < size_[2]; ++z) {
    for (Index y = 1; y + 1 < size_[1]; ++y) {
      for (Index x = 1; x + 1 < size_[0]; ++x) {
        if (!(grid.value(from++) < kThroughCell * spacing_)) continue;
        const std::size_t node = nodeAt(x, y, z);
        cellOf_[node] = cellCount();
        nodes_.push_back(node);
      }
    }
  }
}

std::vector<Index> InsideLattice::cellsAlong(const Bone& bone) {
  std::vector<Index> cells;
  const double length = (bone.b - bone.a).norm();
  const auto steps = static_cast<Index>(std::min(1e6, std::ceil(length / (kPlaceStep * spacing_))));
  for (Index i = 0; i <= steps; ++i) {
    addCellAt(bone.a + (steps > 0 ? static_cast<double>(i) / steps : 0) * (bone.b - bone.a), cells);
  }
  if (!(bone.radius > 0)) return cells;
  const auto reach = static_cast<int>(bone.radius / spacing_);
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Vec3 arm = spacing_ * Vec3(x, y, z);
        if (arm.norm() <= bone.radius) addCellAt(bone.a + arm, cells);
      }
    }
  }
  return cells;
}

void InsideLattice::addCellAt(const Vec3& place, std::vector<Index>& cells) {
  std::array<Index, 3> at;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = std::round((place[axis] - origin_[axis]) / spacing_);
    if (!(steps >= 1 && steps + 1 < size_[axis])) return;
    at[axis] = static_cast<Index>(steps);
  }
  const std::size_t node = nodeAt(at[0], at[1], at[2]);
  if (cellOf_[node] == kNoIndex) {
    cellOf_[node] = cellCount();
    nodes_.push_back(node);
  }
  cells.push_back(cellOf_[node]);
}

int InsideLattice::cellsRound(const Vec3& place, std::array<Index, 8>& cells, std::array<double, 8>& parts) const {
  const Vec3 at = (place - origin_) / spacing_;
  std::array<Index, 3> low;
  std::array<double, 3> part;
  for (int axis = 0; axis < 3; ++axis) {
    const double inside = std::clamp(at[axis], 1.0, size_[axis] - 2.0);
    low[axis] = static_cast<Index>(inside);
    part[axis] = inside - low[axis];
  }
  int count = 0;
  for (Index corner = 0; corner < 8; ++corner) {
    double share = 1;
    std::array<Index, 3> node;
    for (Index axis = 0; axis < 3; ++axis) {
      const bool far = (corner >> axis & 1) != 0;
      node[axis] = low[axis] + far;
      share *= far ? part[axis] : 1 - part[axis];
    }
    const Index cell = cellOf_[nodeAt(node[0], node[1], node[2])];
    if (cell == kNoIndex || !(share > 0)) continue;
    cells[count] = cell;
    parts[count++] = share;
  }
  return count;
}

}  // namespace limber
