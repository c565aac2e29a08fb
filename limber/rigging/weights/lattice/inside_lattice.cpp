#include "limber/rigging/weights/lattice/inside_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/mesh/turned_pieces.h"

namespace limber {

namespace {

constexpr Index kCoarsest = 8;          // spacings, the first cells that are looked at
constexpr double kMargin = 2.5;         // spacings from the mesh to the grid's border, at least
constexpr double kWindingInside = 0.5;  // winding number from which a point lies inside
constexpr double kThroughCell = 0.87;   // spacings: half the diagonal of a cell, which the surface passes through then
constexpr double kSampleStep = 0.5;     // spacings between samples of a bone that are looked at

// Finds on an adaptive grid which nodes lie inside or near the surface, with as few questions to both trees as can be:
// a ball round a node that the surface does not reach lies on one side of it as a whole, so its other nodes need not
// be asked. Only where cells have corners on both sides with no surface near (in the holes of open meshes) is each
// asked.
class NodeSides {
 public:
  NodeSides(const InsideQueries& queries, const Vec3& origin, double spacing, const std::array<Index, 3>& size)
      : queries_(queries),
        origin_(origin),
        spacing_(spacing),
        size_(size),
        nodes_(std::size_t{size[0]} * size[1] * size[2]) {
    std::vector<GridIndex> asked;
    for (Index z = 0; z < size_[2]; z += kCoarsest) {
      for (Index y = 0; y < size_[1]; y += kCoarsest) {
        for (Index x = 0; x < size_[0]; x += kCoarsest) asked.push_back({x, y, z});
      }
    }
    ask(asked);
    for (Index step = kCoarsest / 2; step > 0; step /= 2) {
      asked.clear();
      refine(step, asked);
      ask(asked);
    }
  }

  bool isCell(Index x, Index y, Index z) const {
    const Side side = nodes_[at({x, y, z})].side;
    return side == Side::kInside || side == Side::kNear;
  }

 private:
  using GridIndex = std::array<Index, 3>;
  enum class Side : std::uint8_t { kUnknown, kOutside, kInside, kNear };
  enum class State : std::uint8_t { kNew, kKnown, kAsked };
  struct Node {
    float clear = 0;  // spacings: no surface within; of a queried node: enough of it to keep the inferred side
    Side side = Side::kUnknown;
    State state = State::kNew;
  };

  std::size_t at(const GridIndex& p) const { return (std::size_t{p[2]} * size_[1] + p[1]) * size_[0] + p[0]; }

  void ask(const std::vector<GridIndex>& gridIndices) {
    parallelFor(gridIndices.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Node& node = nodes_[at(gridIndices[i])];
        const Vec3 point = origin_ + spacing_ * Vec3(gridIndices[i][0], gridIndices[i][1], gridIndices[i][2]);
        const auto distance = static_cast<float>(queries_.surface->nearestPoint(point).distance / spacing_);
        if (distance < kThroughCell) {
          node.side = Side::kNear;
        } else if (node.side == Side::kUnknown || distance <= node.clear) {
          node.side = queries_.winding->at(point) > kWindingInside ? Side::kInside : Side::kOutside;
        }
        node.clear = distance;
        node.state = State::kAsked;
      }
    });
  }

  // Looks at each cell of 2 * step, whose corners are known: tells the nodes at `step` in it their side, or has them
  // asked.
  void refine(Index step, std::vector<GridIndex>& asked) {
    const Index cell = 2 * step;
    for (Index z = 0; z + cell < size_[2]; z += cell) {
      for (Index y = 0; y + cell < size_[1]; y += cell) {
        for (Index x = 0; x + cell < size_[0]; x += cell) refineCell({x, y, z}, step, asked);
      }
    }
  }

  void refineCell(const GridIndex& low, Index step, std::vector<GridIndex>& asked) {
    std::array<Node, 8> corners;
    bool inside = false, outside = false;
    for (Index c = 0; c < 8; ++c) {
      corners[c] =
          nodes_[at({low[0] + (c & 1) * 2 * step, low[1] + (c >> 1 & 1) * 2 * step, low[2] + (c >> 2) * 2 * step})];
      inside |= corners[c].side == Side::kInside;
      outside |= corners[c].side == Side::kOutside;
    }
    const Side common = inside == outside ? Side::kUnknown : inside ? Side::kInside : Side::kOutside;
    for (Index n = 0; n < 27; ++n) {
      const GridIndex in = {n % 3, n / 3 % 3, n / 9};
      if (in[0] != 1 && in[1] != 1 && in[2] != 1) continue;  // a corner
      const GridIndex position = {low[0] + in[0] * step, low[1] + in[1] * step, low[2] + in[2] * step};
      Node& node = nodes_[at(position)];
      if (node.state == State::kAsked) {
        if (common == Side::kUnknown) node.side = common;
        continue;
      }
      float clear = -1, nearest = 4.0f * static_cast<float>(step);  // the nearest corner whose side is known
      for (Index c = 0; c < 8; ++c) {
        float squared = 0;
        for (Index axis = 0; axis < 3; ++axis) {
          const float away = static_cast<float>(in[axis]) - 2 * static_cast<float>(c >> axis & 1);
          squared += away * away;
        }
        const float away = std::sqrt(squared) * static_cast<float>(step);
        if (corners[c].side == Side::kNear) continue;
        clear = std::max(clear, corners[c].clear - away);
        nearest = std::min(nearest, away);
      }
      if (common != Side::kUnknown && clear >= kThroughCell) {
        if (node.state == State::kNew) node = {clear, common, State::kKnown};
        continue;
      }
      node = {clear > 0 ? 0 : nearest, common, State::kAsked};
      asked.push_back(position);
    }
  }

  const InsideQueries& queries_;
  const Vec3 origin_;
  const double spacing_;
  const std::array<Index, 3> size_;
  std::vector<Node> nodes_;
};

}  // namespace

InsideQueries::InsideQueries(const TriMesh& mesh) {
  parallelInvoke([&] { surface = std::make_unique<Bvh>(mesh); },
                 [&] { winding = std::make_unique<WindingNumber>(mesh, turnedPieces(mesh)); });
}

InsideLattice::InsideLattice(const TriMesh& mesh, const InsideQueries& queries, Index resolution) {
  if (resolution < kMinCells || resolution > kMaxCells) {
    throw Error(ErrorCode::kBadArgument, fmt::format("a lattice of {} cells is asked for", resolution), {},
                "8 to 512 are possible");
  }
  if (mesh.triangles.empty()) throw Error(ErrorCode::kBadArgument, "a mesh without triangles has no inside");
  const Box box = modelBox(mesh);
  spacing_ = box.longestSide() > 0 ? box.longestSide() / resolution : 1;
  std::array<Index, 3> size;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = box.size()[axis] / spacing_ + 2 * kMargin;
    size[axis] = static_cast<Index>(std::ceil(cells / kCoarsest)) * kCoarsest + 1;
    origin_[axis] = box.center()[axis] - 0.5 * spacing_ * (size[axis] - 1);
    size_[axis] = size[axis] + 2;
  }
  const NodeSides sides(queries, origin_, spacing_, size);
  // One node more on every side, so that every cell has all its neighbors.
  origin_ -= Vec3::Constant(spacing_);
  row_ = size_[0];
  cellOf_.assign(std::size_t{size_[0]} * size_[1] * size_[2], kNoIndex);
  for (Index z = 0; z < size[2]; ++z) {
    for (Index y = 0; y < size[1]; ++y) {
      for (Index x = 0; x < size[0]; ++x) {
        if (!sides.isCell(x, y, z)) continue;
        const std::size_t node = nodeAt(x + 1, y + 1, z + 1);
        cellOf_[node] = cellCount();
        nodes_.push_back(node);
      }
    }
  }
}

Vec3 InsideLattice::position(Index cell) const {
  const std::size_t node = nodes_[cell], x = node % size_[0], y = node / size_[0] % size_[1],
                    z = node / size_[0] / size_[1];
  return origin_ + spacing_ * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

std::vector<Index> InsideLattice::cellsAlong(const Bone& bone) {
  std::vector<Index> cells;
  const double length = (bone.b - bone.a).norm();
  const auto steps = static_cast<Index>(std::min(1e6, std::ceil(length / (kSampleStep * spacing_))));
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

void InsideLattice::addCellAt(const Vec3& position, std::vector<Index>& cells) {
  std::array<Index, 3> at;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = std::round((position[axis] - origin_[axis]) / spacing_);
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

int InsideLattice::cellsRound(const Vec3& position, std::array<Index, 8>& cells, std::array<double, 8>& parts) const {
  const Vec3 at = (position - origin_) / spacing_;
  std::array<Index, 3> low;
  std::array<double, 3> part;
  for (int axis = 0; axis < 3; ++axis) {
    const double inside = std::clamp(at[axis], 1.0, size_[axis] - 2.0);
    low[axis] = static_cast<Index>(inside);
    part[axis] = inside - low[axis];
  }
  int count = 0;
  for (Index corner = 0; corner < 8; ++corner) {
    double fraction = 1;
    std::array<Index, 3> node;
    for (Index axis = 0; axis < 3; ++axis) {
      const bool far = (corner >> axis & 1) != 0;
      node[axis] = low[axis] + far;
      fraction *= far ? part[axis] : 1 - part[axis];
    }
    const Index cell = cellOf_[nodeAt(node[0], node[1], node[2])];
    if (cell == kNoIndex || !(fraction > 0)) continue;
    cells[count] = cell;
    parts[count++] = fraction;
  }
  return count;
}

}  // namespace limber
