// Surface nets (Gibson 1998) on the half x >= 0 of a grid that is symmetric in x.
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "limber/core/parallel.h"
#include "limber/samples/half_mesh.h"

namespace limber {

namespace {

constexpr int kBlock = 4;         // nodes
constexpr double kCertain = 1.6;  // a field value this many block radii from zero keeps its sign in the whole block

// Node i lies at x = (i + 1/2) cube; node -1 mirrors node 0. Cell c lies between nodes c - 1 and c, so cell 0 has the
// plane of symmetry in its middle.
class Grid {
 public:
  Grid(const Sculpture& sculpture, double cube) : cube_(cube) {
    const Box box = sculpture.bounds();
    const Vec3 low = (box.min / cube).array().floor() - 1, high = (box.max / cube).array().ceil() + 2;
    origin_ = Vec3(0.5 * cube, low.y() * cube, low.z() * cube);
    size_ = {int(high.x()), int(high.y() - low.y()), int(high.z() - low.z())};
    values_.assign(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]), 0);
    fill(sculpture);
    repair();
  }

  const std::array<int, 3>& size() const { return size_; }
  Vec3 node(int i, int j, int k) const { return origin_ + cube_ * Vec3(i, j, k); }
  std::size_t index(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size_[1]) + std::size_t(j)) * std::size_t(size_[0]) + std::size_t(i);
  }
  double value(int i, int j, int k) const { return values_[index(i < 0 ? -1 - i : i, j, k)]; }

 private:
  void fill(const Sculpture& sculpture) {
    const int slabs = (size_[2] + kBlock - 1) / kBlock;
    parallelFor(std::size_t(slabs), 1, [&](std::size_t begin, std::size_t end) {
      for (int k = int(begin) * kBlock; k < std::min(int(end) * kBlock, size_[2]); k += kBlock) {
        for (int j = 0; j < size_[1]; j += kBlock) {
          for (int i = 0; i < size_[0]; i += kBlock) fillBlock(sculpture, i, j, k);
        }
      }
    });
  }

  void fillBlock(const Sculpture& sculpture, int i0, int j0, int k0) {
    const double half = 0.5 * (kBlock - 1);
    const double middle = sculpture.distance(node(i0, j0, k0) + Vec3::Constant(half * cube_));
    const bool uniform = std::abs(middle) > kCertain * half * cube_ * std::sqrt(3.0);
    for (int k = k0; k < std::min(k0 + kBlock, size_[2]); ++k) {
      for (int j = j0; j < std::min(j0 + kBlock, size_[1]); ++j) {
        for (int i = i0; i < std::min(i0 + kBlock, size_[0]); ++i) {
          values_[index(i, j, k)] = uniform ? middle : sculpture.distance(node(i, j, k));
        }
      }
    }
  }

  double& at(const std::array<int, 3>& node) {
    return values_[index(node[0] < 0 ? -1 - node[0] : node[0], node[1], node[2])];
  }

  // Where nodes inside touch only across the diagonal of a cube or of its side, surface nets would give a surface that
  // pinches itself. The outside node there that is nearest to the surface is then taken inside, until there is no such
  // pinch.
  void repair() {
    bool changed = true;
    while (changed) {
      changed = false;
      for (int k = 0; k + 1 < size_[2]; ++k) {
        for (int j = 0; j + 1 < size_[1]; ++j) {
          for (int i = -1; i + 1 < size_[0]; ++i) changed = repairCell({i, j, k}) || changed;
        }
      }
    }
  }

  bool repairCell(const std::array<int, 3>& low) {
    const auto corner = [&](int bits) {
      return std::array<int, 3>{low[0] + (bits & 1), low[1] + (bits >> 1 & 1), low[2] + (bits >> 2)};
    };
    int inside = 0;
    for (int bits = 0; bits < 8; ++bits) inside |= (at(corner(bits)) < 0) << bits;
    if (inside == 0 || inside == 255) return false;
    const auto fillNearest = [&](std::initializer_list<int> candidates) {
      double* nearest = nullptr;
      for (const int bits : candidates) {
        double& value = at(corner(bits));
        if (value >= 0 && (!nearest || value < *nearest)) nearest = &value;
      }
      *nearest = -1e-6;
      return true;
    };
    const auto is = [&](int bits) { return (inside >> bits & 1) != 0; };
    constexpr std::array<std::array<int, 4>, 6> kSides = {
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& side : kSides) {
      const bool a = is(side[0]), b = is(side[1]), c = is(side[2]), d = is(side[3]);
      if (a == c && b == d && a != b) return fillNearest({side[0], side[1], side[2], side[3]});
    }
    for (int bits = 0; bits < 4; ++bits) {
      const int pair = 1 << bits | 1 << (7 - bits);
      if (inside == pair || inside == (255 ^ pair)) return fillNearest({0, 1, 2, 3, 4, 5, 6, 7});
    }
    return false;
  }

  double cube_;
  Vec3 origin_;
  std::array<int, 3> size_;
  std::vector<double> values_;
};

// The mean of the points where the cell's edges cross the surface; false where none does.
bool cellVertex(const Grid& grid, int i, int j, int k, Vec3& vertex) {
  Vec3 sum = Vec3::Zero();
  int crossings = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> at = {i - 1 + (corner & 1), j - 1 + (corner >> 1 & 1), k - 1 + (corner >> 2)};
    const double value = grid.value(at[0], at[1], at[2]);
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      std::array<int, 3> to = at;
      ++to[std::size_t(axis)];
      const double other = grid.value(to[0], to[1], to[2]);
      if ((value < 0) == (other < 0)) continue;
      const double t = value / (value - other);
      sum += (1 - t) * grid.node(at[0], at[1], at[2]) + t * grid.node(to[0], to[1], to[2]);
      ++crossings;
    }
  }
  if (crossings == 0) return false;
  vertex = sum / crossings;
  if (i == 0) vertex.x() = 0;
  return true;
}

// Two quads with two common sides (the grid grazes the surface there) have the same two vertices across: only one of
// them may be cut along the line between these.
using Diagonals = std::set<std::pair<Index, Index>>;

// The quad round a grid edge as two triangles, along its shorter diagonal if that is free.
void addQuad(HalfMesh& mesh, const std::array<Index, 4>& q, bool flipped, Diagonals& taken) {
  const double first = (mesh.positions[q[0]] - mesh.positions[q[2]]).squaredNorm();
  const double second = (mesh.positions[q[1]] - mesh.positions[q[3]]).squaredNorm();
  std::size_t from = first <= second ? 0 : 1;
  if (!taken.insert(std::minmax(q[from], q[from + 2])).second) {
    from = 1 - from;
    taken.insert(std::minmax(q[from], q[from + 2]));
  }
  const Index a = q[from], b = q[from + 1], c = q[from + 2], d = q[(from + 3) % 4];
  for (Triangle triangle : {Triangle{a, b, c}, Triangle{a, c, d}}) {
    if (flipped) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
}

}  // namespace

HalfMesh polygonize(const Sculpture& sculpture, double cube) {
  const Grid grid(sculpture, cube);
  const auto [nx, ny, nz] = grid.size();
  HalfMesh mesh;
  std::vector<Index> vertexOf(std::size_t(nx) * std::size_t(ny) * std::size_t(nz), kNoIndex);
  for (int k = 1; k < nz; ++k) {
    for (int j = 1; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        Vec3 vertex;
        if (!cellVertex(grid, i, j, k, vertex)) continue;
        vertexOf[grid.index(i, j, k)] = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back(vertex);
      }
    }
  }
  Diagonals taken;
  for (int k = 1; k + 1 < nz; ++k) {
    for (int j = 1; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        const std::array<int, 3> at = {i, j, k};
        const bool inside = grid.value(i, j, k) < 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<int, 3> to = at, u = {0, 0, 0}, v = {0, 0, 0};
          ++to[axis];
          if ((grid.value(to[0], to[1], to[2]) < 0) == inside) continue;
          u[(axis + 1) % 3] = 1;
          v[(axis + 2) % 3] = 1;
          // The four cells round the edge from node (i, j, k): one above it along `axis`, and to either side of it.
          const auto cell = [&](int du, int dv) {
            return vertexOf[grid.index(to[0] + (axis == 0 ? 0 : du * u[0] + dv * v[0]),
                                       to[1] + (axis == 1 ? 0 : du * u[1] + dv * v[1]),
                                       to[2] + (axis == 2 ? 0 : du * u[2] + dv * v[2]))];
          };
          addQuad(mesh, {cell(0, 0), cell(1, 0), cell(1, 1), cell(0, 1)}, !inside, taken);
        }
      }
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  relax(mesh, sculpture, 6);
  return mesh;
}

}  // namespace limber
