#include "limber/geometry/mesh/signed_distance.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

constexpr Index kCoarsest = 8;   // spacings, the first cells
constexpr double kMargin = 2.5;  // spacings from the box to the grid's border, at least
constexpr double kInside = 0.5;  // winding number from which a point lies inside

}  // namespace

SignedDistance::SignedDistance(const TriMesh& mesh, const Bvh& surface, const WindingNumber& winding,
                               Index resolution) {
  if (resolution < 8 || resolution > 512) {
    throw Error(ErrorCode::kBadArgument, fmt::format("a grid of {} cells is asked for", resolution), {},
                "8 to 512 are possible");
  }
  if (mesh.triangles.empty()) throw Error(ErrorCode::kBadArgument, "a mesh without triangles has no distances");
  const Box box = modelBox(mesh);
  spacing_ = box.longestSide() > 0 ? box.longestSide() / resolution : 1;
  perSpacing_ = 1 / spacing_;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = box.size()[axis] / spacing_ + 2 * kMargin;
    size_[axis] = static_cast<Index>(std::ceil(cells / kCoarsest)) * kCoarsest + 1;
    last_[axis] = size_[axis] - 1;
    origin_[axis] = box.center()[axis] - 0.5 * spacing_ * last_[axis];
  }
  values_.assign(std::size_t{size_[0]} * size_[1] * size_[2], 0.0f);
  refine(surface, winding);
}

Vec3 SignedDistance::position(std::size_t node) const {
  const std::size_t x = node % size_[0], y = node / size_[0] % size_[1], z = node / size_[0] / size_[1];
  return origin_ + spacing_ * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

void SignedDistance::measure(const std::vector<std::size_t>& nodes, const Bvh& surface, const WindingNumber& winding) {
  parallelFor(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 point = position(nodes[i]);
      const double distance = surface.nearestPoint(point).distance;
      values_[nodes[i]] = static_cast<float>(winding.at(point) > kInside ? -distance : distance);
    }
  });
}

// Looks at each cell of 2 * step, whose corners are known: gives the nodes at `step` in it their values, or asks for
// them to be measured.
void SignedDistance::settle(Index step, std::vector<char>& known, std::vector<std::size_t>& wanted) {
  enum : char { kUnknown, kBetween, kMeasured };
  const Index cell = 2 * step;
  // From the nearest corner to any point within one spacing of the cell.
  const double reach = (0.5 * std::sqrt(3.0) * cell + 1) * spacing_;
  for (Index z = 0; z + cell < size_[2]; z += cell) {
    for (Index y = 0; y + cell < size_[1]; y += cell) {
      for (Index x = 0; x + cell < size_[0]; x += cell) {
        float corner[8], nearest = std::numeric_limits<float>::infinity();
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
          corner[c] = values_[nodeAt(x + (c & 1 ? cell : 0), y + (c & 2 ? cell : 0), z + (c & 4 ? cell : 0))];
          nearest = std::min(nearest, std::abs(corner[c]));
          inside += corner[c] < 0;
        }
        const bool near = nearest <= reach || (inside != 0 && inside != 8);
        for (int n = 0; n < 27; ++n) {
          const Index dx = static_cast<Index>(n % 3), dy = static_cast<Index>(n / 3 % 3),
                      dz = static_cast<Index>(n / 9);
          if (dx != 1 && dy != 1 && dz != 1) continue;  // a corner
          const std::size_t node = nodeAt(x + dx * step, y + dy * step, z + dz * step);
          if (near) {
            if (known[node] != kMeasured) wanted.push_back(node);
            known[node] = kMeasured;
          } else if (known[node] == kUnknown) {
            float sum = 0;
            for (int c = 0; c < 8; ++c) {
              const Index wx = c & 1 ? dx : 2 - dx, wy = c & 2 ? dy : 2 - dy, wz = c & 4 ? dz : 2 - dz;
              sum += static_cast<float>(wx * wy * wz) * corner[c];
            }
            values_[node] = sum / 8;
            known[node] = kBetween;
          }
        }
      }
    }
  }
}

void SignedDistance::refine(const Bvh& surface, const WindingNumber& winding) {
  std::vector<char> known(values_.size(), 0);
  std::vector<std::size_t> wanted;
  for (Index z = 0; z < size_[2]; z += kCoarsest) {
    for (Index y = 0; y < size_[1]; y += kCoarsest) {
      for (Index x = 0; x < size_[0]; x += kCoarsest) wanted.push_back(nodeAt(x, y, z));
    }
  }
  measure(wanted, surface, winding);
  for (Index step = kCoarsest / 2; step > 0; step /= 2) {
    wanted.clear();
    settle(step, known, wanted);
    measure(wanted, surface, winding);
  }
}

Index cellsForNodes(const TriMesh& mesh, double nodes, double least, double most) {
  const Box box = modelBox(mesh);
  const Vec3 sides = box.size() / std::max(box.longestSide(), 1e-12);
  return static_cast<Index>(std::clamp(std::cbrt(nodes / std::max(sides.prod(), 1e-3)), least, most));
}

}  // namespace limber
