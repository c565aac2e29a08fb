#include "limber/rigging/weights/lattice/geodesic_voxel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/signed_distance.h"
#include "limber/rigging/weights/bone_distance.h"
#include "limber/rigging/weights/lattice/inside_lattice.h"
#include "limber/rigging/weights/weight_steps.h"

namespace limber {

namespace {

constexpr double kUnitOfFalloff = 0.01;                                // longest sides
constexpr int kUnit = 10;                                              // length of a step to a neighbor by face
constexpr std::array<std::uint32_t, 4> kStepLength = {0, 10, 14, 17};  // by the number of axes that a step goes along
constexpr double kMaxMissing = 0.5;  // of the cells round a vertex: what fewer reach is far

// The cells of the inside as a graph, each with the joints nearest to it.
class VoxelDistances {
 public:
  VoxelDistances(InsideLattice& lattice, Index followed) : lattice_(lattice), followed_(followed) {}

  // The cells that a bone passes through, or fills, whether they are inside or not.
  void addBone(const Bone& bone) {
    for (const Index cell : lattice_.cellsAlong(bone)) {
      if (seeds_.empty() || seeds_.back().cell != cell || seeds_.back().joint != bone.joint) {
        seeds_.push_back({cell, bone.joint});
      }
    }
  }

  // Follows all joints at once: cells are settled in the order of path length, each by the first few joints to arrive.
  void run(Progress& progress) {
    const std::vector<Step> steps = allSteps();
    joints_.assign(std::size_t{lattice_.cellCount()} * followed_, kNoIndex);
    distances_.assign(std::size_t{lattice_.cellCount()} * followed_, 0);
    counts_.assign(lattice_.cellCount(), 0);
    constexpr std::size_t kRing = 18;  // longer than any step
    std::array<std::vector<Arrival>, kRing> ring;
    ring[0] = std::move(seeds_);
    std::size_t waiting = ring[0].size();
    for (std::uint32_t distance = 0; waiting > 0; ++distance) {
      std::vector<Arrival> now;
      now.swap(ring[distance % kRing]);
      waiting -= now.size();
      if (distance % 256 == 0) progress.update(0);
      for (const Arrival& arrival : now) {
        if (!settle(arrival, distance)) continue;
        for (const Step& step : steps) {
          const Index next = lattice_.neighbor(arrival.cell, step.offset);
          if (next == kNoIndex || !isOpen(next, arrival.joint)) continue;
          ring[(distance + step.length) % kRing].push_back({next, arrival.joint});
          ++waiting;
        }
      }
    }
  }

  // The path lengths (longest sides) from a position to joints, from those of the cells round it; few of the far ones.
  template <class Take>
  void forEachDistance(const Vec3& position, const Take& take) const {
    std::array<Index, 8> cells;
    std::array<double, 8> fractions;
    const int count = lattice_.cellsRound(position, cells, fractions);
    std::array<Index, 64> joints;
    std::array<double, 64> sums, reached;
    std::size_t known = 0;
    double all = 0;
    for (int i = 0; i < count; ++i) {
      if (counts_[cells[i]] == 0) continue;
      all += fractions[i];
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
        sums[j] += fractions[i] * distances_[slot];
        reached[j] += fractions[i];
      }
    }
    for (std::size_t j = 0; j < known; ++j) {
      if (reached[j] < kMaxMissing * all) continue;
      take(joints[j], std::max(lattice_.spacing() / 2, lattice_.spacing() / kUnit * sums[j] / reached[j]));
    }
  }

 private:
  struct Arrival {
    Index cell, joint;
  };
  struct Step {
    std::ptrdiff_t offset;
    std::uint32_t length;
  };

  std::vector<Step> allSteps() const {
    std::vector<Step> steps;
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const int axes = std::abs(x) + std::abs(y) + std::abs(z);
          if (axes > 0) steps.push_back({lattice_.step(x, y, z), kStepLength[static_cast<std::size_t>(axes)]});
        }
      }
    }
    return steps;
  }

  bool isOpen(Index cell, Index joint) const {
    const Index count = counts_[cell];
    if (count == followed_) return false;
    const auto first = joints_.begin() + static_cast<std::ptrdiff_t>(std::size_t{cell} * followed_);
    return std::find(first, first + count, joint) == first + count;
  }

  bool settle(const Arrival& arrival, std::uint32_t distance) {
    if (!isOpen(arrival.cell, arrival.joint)) return false;
    const std::size_t slot = std::size_t{arrival.cell} * followed_ + counts_[arrival.cell]++;
    joints_[slot] = arrival.joint;
    distances_[slot] = distance;
    return true;
  }

  InsideLattice& lattice_;
  Index followed_;
  std::vector<Arrival> seeds_;
  std::vector<Index> joints_;             // followed_ for each cell, nearest first
  std::vector<std::uint32_t> distances_;  // likewise, in tenths of a spacing
  std::vector<std::uint8_t> counts_;      // by cell: joints that came
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
  InsideLattice lattice(mesh, InsideQueries(mesh),
                        cellsForNodes(mesh, voxels.nodes, InsideLattice::kMinCells, voxels.maxCells));

  progress.step("ways to bones");
  VoxelDistances distances(lattice, std::max<Index>(4, options.maxInfluences + 2));
  for (const Bone& bone : bones) distances.addBone(bone);
  distances.run(progress);

  progress.step("weights");
  InfluenceTable table(mesh.vertexCount(), options.maxInfluences);
  parallelFor(mesh.vertexCount(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      distances.forEachDistance(mesh.position(static_cast<Index>(v)), [&](Index joint, double distance) {
        const double d = distance / kUnitOfFalloff, far = (1 - voxels.falloff) * d + voxels.falloff * d * d;
        table.offer(v, joint, static_cast<float>(1 / (far * far)));
      });
    }
  });

  return bridgedWeights(mesh, bones, options, table, progress);
}

}  // namespace limber
