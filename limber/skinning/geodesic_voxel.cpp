#include "limber/skinning/geodesic_voxel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "limber/core/parallel.h"
#include "limber/mesh/bvh.h"
#include "limber/mesh/signed_distance.h"
#include "limber/mesh/turned_pieces.h"
#include "limber/mesh/winding_number.h"
#include "limber/skinning/bone_distance.h"
#include "limber/skinning/weight_steps.h"

namespace limber {

namespace {

constexpr Index kLeastCells = 8;         // along the longest side
constexpr double kThroughCell = 0.87;    // spacings: half the diagonal of a cell, which the surface passes through then
constexpr double kUnitOfFalloff = 0.01;  // longest sides
constexpr int kUnit = 10;                // of a way, to a cell
constexpr std::array<int, 4> kStepLength = {0, 10, 14, 17};  // by the number of axes that a step goes along
constexpr double kSeedStep = 0.5;                            // spacings between places of a bone that are looked at
constexpr double kMostMissing = 0.5;                         // of the cells round a vertex: what fewer reach is far

using Place = std::array<Index, 3>;

// The cells of the inside as a graph, each with the joints nearest to it.
class VoxelWays {
 public:
  VoxelWays(const SignedDistance& grid, Index followed) : grid_(grid), followed_(followed), cell_(grid.nodeCount()) {
    for (std::size_t node = 0; node < grid.nodeCount(); ++node) {
      cell_[node] = grid.value(node) < kThroughCell * grid.spacing() ? addCell(node) : kNoIndex;
    }
  }

  // The cells that a bone passes through, or fills, whether they are inside or not.
  void addBone(const Bone& bone) {
    const double length = (bone.b - bone.a).norm(), step = kSeedStep * grid_.spacing();
    const auto steps = static_cast<Index>(std::min(1e6, std::ceil(length / step)));
    for (Index i = 0; i <= steps; ++i) {
      const Vec3 at = bone.a + (steps > 0 ? static_cast<double>(i) / steps : 0) * (bone.b - bone.a);
      addSeed(at, bone.joint);
    }
    if (!(bone.radius > 0)) return;
    const auto reach = static_cast<int>(bone.radius / grid_.spacing());
    for (int z = -reach; z <= reach; ++z) {
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          const Vec3 arm = grid_.spacing() * Vec3(x, y, z);
          if (arm.norm() <= bone.radius) addSeed(bone.a + arm, bone.joint);
        }
      }
    }
  }

  // Follows all joints at once: cells are settled in the order of their ways, each by the first few joints that come.
  void run(Progress& progress) {
    const std::vector<Step> steps = allSteps();
    joints_.assign(nodes_.size() * followed_, kNoIndex);
    ways_.assign(nodes_.size() * followed_, 0);
    counts_.assign(nodes_.size(), 0);
    constexpr std::size_t kRing = 18;  // longer than any step
    std::array<std::vector<Arrival>, kRing> ring;
    ring[0] = std::move(seeds_);
    std::size_t waiting = ring[0].size();
    for (std::uint32_t way = 0; waiting > 0; ++way) {
      std::vector<Arrival> now;
      now.swap(ring[way % kRing]);
      waiting -= now.size();
      if (way % 256 == 0) progress.update(0);
      for (const Arrival& arrival : now) {
        if (!settle(arrival, way)) continue;
        const Place at = placeOf(nodes_[arrival.cell]);
        for (const Step& step : steps) {
          const Index next = neighbor(at, step);
          if (next == kNoIndex || !isOpen(next, arrival.joint)) continue;
          ring[(way + step.length) % kRing].push_back({next, arrival.joint});
          ++waiting;
        }
      }
    }
  }

  // The ways (longest sides) from a place to joints, from those of the cells round it; few of the far ones.
  template <class Take>
  void forEachWay(const Vec3& place, const Take& take) const {
    std::array<Index, 8> cells;
    std::array<double, 8> shares;
    const int count = cellsRound(place, cells, shares);
    std::array<Index, 64> joints;
    std::array<double, 64> sums, reached;
    std::size_t known = 0;
    double all = 0;
    for (int i = 0; i < count; ++i) {
      all += shares[i];
      for (Index k = 0; k < counts_[cells[i]]; ++k) {
        const std::size_t slot = std::size_t{cells[i]} * followed_ + k;
        const Index joint = joints_[slot];
        std::size_t j = 0;
        while (j < known && joints[j] != joint) ++j;
        if (j == joints.size()) continue;
        if (j == known) {
          joints[known] = joint;
          sums[known] = reached[known] = 0;
          ++known;
        }
        sums[j] += shares[i] * ways_[slot];
        reached[j] += shares[i];
      }
    }
    for (std::size_t j = 0; j < known; ++j) {
      if (reached[j] < kMostMissing * all) continue;
      take(joints[j], std::max(grid_.spacing() / 2, grid_.spacing() / kUnit * sums[j] / reached[j]));
    }
  }

 private:
  struct Arrival {
    Index cell, joint;
  };
  struct Step {
    int x, y, z, length;
  };

  Index addCell(std::size_t node) {
    nodes_.push_back(node);
    return static_cast<Index>(nodes_.size() - 1);
  }

  static std::vector<Step> allSteps() {
    std::vector<Step> steps;
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const int axes = std::abs(x) + std::abs(y) + std::abs(z);
          if (axes > 0) steps.push_back({x, y, z, kStepLength[static_cast<std::size_t>(axes)]});
        }
      }
    }
    return steps;
  }

  Place placeOf(std::size_t node) const {
    const std::size_t row = grid_.size()[0], slice = row * grid_.size()[1];
    return {static_cast<Index>(node % row), static_cast<Index>(node / row % grid_.size()[1]),
            static_cast<Index>(node / slice)};
  }

  Index neighbor(const Place& at, const Step& step) const {
    // Below 0 they wrap round to numbers beyond the grid.
    const Index x = at[0] + static_cast<Index>(step.x), y = at[1] + static_cast<Index>(step.y),
                z = at[2] + static_cast<Index>(step.z);
    if (x >= grid_.size()[0] || y >= grid_.size()[1] || z >= grid_.size()[2]) return kNoIndex;
    return cell_[grid_.nodeAt(x, y, z)];
  }

  void addSeed(const Vec3& place, Index joint) {
    const Vec3 first = grid_.position(0);
    Place at;
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::round((place[axis] - first[axis]) / grid_.spacing());
      if (!(steps >= 0 && steps < grid_.size()[axis])) return;
      at[axis] = static_cast<Index>(steps);
    }
    const std::size_t node = grid_.nodeAt(at[0], at[1], at[2]);
    if (cell_[node] == kNoIndex) cell_[node] = addCell(node);
    if (!seeds_.empty() && seeds_.back().cell == cell_[node] && seeds_.back().joint == joint) return;
    seeds_.push_back({cell_[node], joint});
  }

  bool isOpen(Index cell, Index joint) const {
    const Index count = counts_[cell];
    if (count == followed_) return false;
    const auto first = joints_.begin() + static_cast<std::ptrdiff_t>(std::size_t{cell} * followed_);
    return std::find(first, first + count, joint) == first + count;
  }

  bool settle(const Arrival& arrival, std::uint32_t way) {
    if (!isOpen(arrival.cell, arrival.joint)) return false;
    const std::size_t slot = std::size_t{arrival.cell} * followed_ + counts_[arrival.cell]++;
    joints_[slot] = arrival.joint;
    ways_[slot] = way;
    return true;
  }

  // The cells among the eight nodes round a place, and their shares of it by linear interpolation. Returns how many.
  int cellsRound(const Vec3& place, std::array<Index, 8>& cells, std::array<double, 8>& shares) const {
    const Vec3 at = (place - grid_.position(0)) / grid_.spacing();
    std::array<Index, 3> low;
    std::array<double, 3> part;
    for (int axis = 0; axis < 3; ++axis) {
      const double inside = std::clamp(at[axis], 0.0, grid_.size()[axis] - 1.0);
      low[axis] = std::min(static_cast<Index>(inside), grid_.size()[axis] - 2);
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
      const Index cell = cell_[grid_.nodeAt(node[0], node[1], node[2])];
      if (cell == kNoIndex || counts_[cell] == 0 || !(share > 0)) continue;
      cells[count] = cell;
      shares[count++] = share;
    }
    return count;
  }

  const SignedDistance& grid_;
  Index followed_;
  std::vector<Index> cell_;         // by node: its cell; kNoIndex outside
  std::vector<std::size_t> nodes_;  // by cell
  std::vector<Arrival> seeds_;
  std::vector<Index> joints_;         // followed_ for each cell, nearest first
  std::vector<std::uint32_t> ways_;   // likewise, in tenths of a spacing
  std::vector<std::uint8_t> counts_;  // by cell: joints that came
};

}  // namespace

WeightResult geodesicVoxelWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                  Progress& progress) {
  return geodesicVoxelWeightsWith({}, mesh, bones, options, progress);
}

WeightResult geodesicVoxelWeightsWith(const GeodesicVoxelOptions& voxels, const TriMesh& mesh,
                                      std::span<const Bone> bones, const WeightOptions& options, Progress& progress) {
  checkWeightArguments(mesh, bones, options);
  progress.step("voxels");
  std::unique_ptr<Bvh> surface;
  std::unique_ptr<WindingNumber> winding;
  parallelInvoke([&] { surface = std::make_unique<Bvh>(mesh); },
                 [&] { winding = std::make_unique<WindingNumber>(mesh, turnedPieces(mesh)); });
  const SignedDistance grid(mesh, *surface, *winding, cellsForNodes(mesh, voxels.nodes, kLeastCells, voxels.mostCells));

  progress.step("ways to bones");
  VoxelWays ways(grid, std::max<Index>(4, options.maxInfluences + 2));
  for (const Bone& bone : bones) ways.addBone(bone);
  ways.run(progress);

  progress.step("weights");
  InfluenceTable table(mesh.vertexCount(), options.maxInfluences);
  parallelFor(mesh.vertexCount(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      ways.forEachWay(mesh.position(static_cast<Index>(v)), [&](Index joint, double way) {
        const double d = way / kUnitOfFalloff, far = (1 - voxels.falloff) * d + voxels.falloff * d * d;
        table.offer(v, joint, static_cast<float>(1 / (far * far)));
      });
    }
  });

  progress.step("bridge pieces");
  WeightResult result;
  result.bridged = bridgeBare(mesh, table);
  result.weights = normalizedWeights(table);
  Index bare = 0;
  while (bare < mesh.vertexCount() && result.weights.weightsOf(bare)[0] > 0) ++bare;
  if (bare < mesh.vertexCount()) {
    result = nearestBoneWeights(mesh, bones, options, progress);
    result.warnings.add("no-bone-in-sight", "no bone reaches the model, so each vertex took the nearest bone");
  } else if (options.pieces == PieceMode::kRigid) {
    bindWholePieces(mesh, result);
  }
  return result;
}

}  // namespace limber
