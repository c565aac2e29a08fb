#include "limber/rigging/weights/lattice/bounded_biharmonic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/signed_distance.h"
#include "limber/rigging/weights/bone_distance.h"
#include "limber/rigging/weights/jointed_pieces.h"
#include "limber/rigging/weights/lattice/inside_lattice.h"
#include "limber/rigging/weights/lattice/lattice_biharmonic.h"
#include "limber/rigging/weights/weight_steps.h"

namespace limber {

namespace {

constexpr double kCoarseNodes = 5e3;     // of the grid that the first descent is on
constexpr double kCoarseTolerance = 10;  // times the tolerance, on it
constexpr double kCoarseEnough = 0.7;    // of the resolution of the grid that the last descent is on
constexpr double kSurely = 0.2;          // of the path between bones, at both ends: there weights begin at 0 or 1
constexpr Index kJointsAtOnce = 16;      // between looks at whether to go on

LatticeGraph graphOf(const InsideLattice& lattice) {
  const std::array<std::ptrdiff_t, 6> steps = {lattice.step(-1, 0, 0), lattice.step(1, 0, 0),  lattice.step(0, -1, 0),
                                               lattice.step(0, 1, 0),  lattice.step(0, 0, -1), lattice.step(0, 0, 1)};
  LatticeGraph graph;
  graph.neighbors.resize(lattice.cellCount());
  for (Index cell = 0; cell < lattice.cellCount(); ++cell) {
    for (std::size_t d = 0; d < steps.size(); ++d) graph.neighbors[cell][d] = lattice.neighbor(cell, steps[d]);
  }
  return graph;
}

// The cells that are pinned where bones pass, for each joint that has a part of them.
struct PinnedCells {
  struct Part {
    Index cell;
    double part;
  };
  std::vector<Index> joints;             // ascending: those that hold any cell
  std::vector<std::vector<Part>> parts;  // by joint of these; cells ascending
  std::vector<bool> pinned;              // by cell
};

PinnedCells holdCells(InsideLattice& lattice, std::span<const Bone> bones) {
  std::map<Index, std::map<Index, double>> byJoint;  // how many samples of its bones lie in a cell
  for (Bone bone : bones) {
    bone.radius = 0;
    for (const Index cell : lattice.cellsAlong(bone)) byJoint[bone.joint][cell] += 1;
  }
  std::vector<double> all(lattice.cellCount(), 0);
  for (const auto& [joint, cells] : byJoint) {
    for (const auto& [cell, positions] : cells) all[cell] += positions;
  }
  PinnedCells result;
  for (const auto& [joint, cells] : byJoint) {
    result.joints.push_back(joint);
    result.parts.emplace_back();
    for (const auto& [cell, positions] : cells) result.parts.back().push_back({cell, positions / all[cell]});
  }
  for (const double positions : all) result.pinned.push_back(positions > 0);
  return result;
}

// One of the two lattices that weights are found on, one after the other.
struct Level {
  InsideLattice lattice;
  PinnedCells cells;
  LatticeGraph graph;

  Level(const TriMesh& mesh, const InsideQueries& queries, std::span<const Bone> bones, Index resolution)
      : lattice(mesh, queries, resolution), cells(holdCells(lattice, bones)), graph(graphOf(lattice)) {}
};

// Weights at the cells of a lattice.
struct LatticeWeights {
  std::vector<Index> joints;   // ascending: those that hold any cell
  std::vector<float> weights;  // cells' rows, a column for each of the joints
};

// By node: the fewest edges to one of some; kNoIndex where there is no path.
std::vector<Index> edgesFrom(const LatticeGraph& graph, std::vector<Index> front) {
  std::vector<Index> edges(graph.nodeCount(), kNoIndex);
  for (const Index node : front) edges[node] = 0;
  for (std::size_t i = 0; i < front.size(); ++i) {
    for (const Index next : graph.neighbors[front[i]]) {
      if (next == kNoIndex || edges[next] != kNoIndex) continue;
      edges[next] = edges[front[i]] + 1;
      front.push_back(next);
    }
  }
  return edges;
}

// Nodes that a joint holds have its part there, all others 0.
std::vector<double> pinnedWeights(const Level& level, std::size_t joint) {
  std::vector<double> w(level.graph.nodeCount(), 0);
  for (const PinnedCells::Part& pinned : level.cells.parts[joint]) w[pinned.cell] = pinned.part;
  return w;
}

// Where the first descent begins: what the weights of a bar between two bones are, by the path lengths to the joint's
// own cells and to those of others.
std::vector<double> weightsByDistance(const Level& level, std::size_t joint) {
  std::vector<double> w = pinnedWeights(level, joint);
  std::vector<Index> own, others;
  for (const PinnedCells::Part& pinned : level.cells.parts[joint]) own.push_back(pinned.cell);
  for (Index node = 0; node < w.size(); ++node) {
    if (level.cells.pinned[node] && w[node] < 1) others.push_back(node);
  }
  const std::vector<Index> toOwn = edgesFrom(level.graph, own), toOthers = edgesFrom(level.graph, others);
  for (Index node = 0; node < w.size(); ++node) {
    if (level.cells.pinned[node] || toOwn[node] == kNoIndex) continue;
    const double along = toOthers[node] == kNoIndex ? 1 : toOthers[node] / (1.0 * toOthers[node] + toOwn[node]);
    const double t = std::clamp((along - kSurely) / (1 - 2 * kSurely), 0.0, 1.0);
    w[node] = t * t * (3 - 2 * t);
  }
  return w;
}

// By cell of the fine lattice those of the coarse one round it. Cells that no bone reaches stay 0.
std::vector<double> interpolated(const Level& fine, std::size_t joint, const std::vector<bool>& reached,
                                 const Level& coarse, const LatticeWeights& weights, std::size_t column) {
  std::vector<double> w = pinnedWeights(fine, joint);
  for (Index node = 0; node < w.size(); ++node) {
    if (fine.cells.pinned[node] || !reached[node]) continue;
    std::array<Index, 8> cells;
    std::array<double, 8> parts;
    const int count = coarse.lattice.cellsRound(fine.lattice.position(node), cells, parts);
    double all = 0, sum = 0;
    for (int i = 0; i < count; ++i) {
      all += parts[i];
      sum += parts[i] * weights.weights[cells[i] * weights.joints.size() + column];
    }
    if (all > 0) w[node] = sum / all;
  }
  return w;
}

std::vector<bool> reachedCells(const Level& level) {
  std::vector<Index> pinned;
  for (Index node = 0; node < level.graph.nodeCount(); ++node) {
    if (level.cells.pinned[node]) pinned.push_back(node);
  }
  std::vector<bool> reached;
  for (const Index edges : edgesFrom(level.graph, pinned)) reached.push_back(edges != kNoIndex);
  return reached;
}

// The weights of all joints, found by descent from `begin(joint)`.
template <class Begin>
LatticeWeights solveJoints(const Level& level, double tolerance, Progress& progress, const Begin& begin) {
  LatticeWeights result{level.cells.joints, {}};
  const std::size_t joints = result.joints.size();
  result.weights.resize(level.graph.nodeCount() * joints);
  BiharmonicOptions options;
  options.tolerance = tolerance;
  for (std::size_t first = 0; first < joints; first += kJointsAtOnce) {
    progress.update(static_cast<double>(first) / static_cast<double>(joints));
    parallelFor(std::min<std::size_t>(kJointsAtOnce, joints - first), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t j = first + from; j < first + to; ++j) {
        std::vector<double> w = begin(j);
        minimizeBoundedBiharmonic(level.graph, level.cells.pinned, w, options);
        for (std::size_t node = 0; node < w.size(); ++node) {
          result.weights[node * joints + j] = static_cast<float>(w[node]);
        }
      }
    });
  }
  return result;
}

// A resolution at which about as many cells are inside as are asked for, told from those of another one. Seldom more:
// finer ones of a body, and coarser ones of a sheet, have as many; others fewer.
Index resolutionFor(double cells, Index most, Index other, Index otherCells) {
  const double ratio = cells / std::max<Index>(1, otherCells), finer = ratio > 1 ? std::cbrt(ratio) : std::sqrt(ratio);
  return static_cast<Index>(std::clamp<double>(other * finer, InsideLattice::kMinCells, most));
}

// Weights that are not above the least count as none.
InfluenceTable sampleAtVertices(const TriMesh& mesh, const InsideLattice& lattice, const LatticeWeights& weights,
                                Index slots, double least) {
  const std::vector<Index>& joints = weights.joints;
  InfluenceTable table(mesh.vertexCount(), slots);
  parallelFor(mesh.vertexCount(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sums(joints.size());
    for (std::size_t v = begin; v < end; ++v) {
      std::array<Index, 8> cells;
      std::array<double, 8> parts;
      const int count = lattice.cellsRound(mesh.position(static_cast<Index>(v)), cells, parts);
      std::fill(sums.begin(), sums.end(), 0.0);
      for (int i = 0; i < count; ++i) {
        const float* row = weights.weights.data() + cells[i] * joints.size();
        for (std::size_t j = 0; j < joints.size(); ++j) sums[j] += parts[i] * row[j];
      }
      for (std::size_t j = 0; j < joints.size(); ++j) {
        if (sums[j] > least) table.offer(v, joints[j], static_cast<float>(sums[j]));
      }
    }
  });
  return table;
}

}  // namespace

WeightResult boundedBiharmonicWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                      Progress& progress) {
  return boundedBiharmonicWeightsWith({}, mesh, bones, options, progress);
}

WeightResult boundedBiharmonicWeightsWith(const BoundedBiharmonicOptions& biharmonic, const TriMesh& mesh,
                                          std::span<const Bone> bones, const WeightOptions& options,
                                          Progress& progress) {
  checkWeightArguments(mesh, bones, options);
  progress.step("pieces");
  Index pieceCount = 0;
  const std::vector<Index> piece = vertexComponents(mesh, &pieceCount);
  if (std::optional<WeightResult> parts = jointedPieceWeights(mesh, piece, pieceCount, bones, options, progress)) {
    return std::move(*parts);
  }

  progress.step("lattice");
  const InsideQueries queries(mesh);
  const Index first = cellsForNodes(mesh, kCoarseNodes, InsideLattice::kMinCells, biharmonic.maxCells);
  auto coarse = std::make_unique<Level>(mesh, queries, bones, first);
  const Index cells = coarse->graph.nodeCount(),
              resolution = resolutionFor(biharmonic.cells, biharmonic.maxCells, first, cells);
  const Level fine(mesh, queries, bones, resolution);
  if (first > kCoarseEnough * resolution) {
    coarse = std::make_unique<Level>(mesh, queries, bones, std::max(InsideLattice::kMinCells, resolution / 2));
  }

  progress.step("smoothest weights");
  const LatticeWeights begin = solveJoints(*coarse, kCoarseTolerance * biharmonic.tolerance, progress,
                                           [&](std::size_t joint) { return weightsByDistance(*coarse, joint); });
  const std::vector<bool> reached = reachedCells(fine);
  const LatticeWeights weights = solveJoints(fine, biharmonic.tolerance, progress, [&](std::size_t joint) {
    const auto column = std::lower_bound(begin.joints.begin(), begin.joints.end(), fine.cells.joints[joint]);
    if (column == begin.joints.end() || *column != fine.cells.joints[joint]) return weightsByDistance(fine, joint);
    return interpolated(fine, joint, reached, *coarse, begin, static_cast<std::size_t>(column - begin.joints.begin()));
  });

  progress.step("weights");
  InfluenceTable table = sampleAtVertices(mesh, fine.lattice, weights, options.maxInfluences, biharmonic.tolerance);
  return bridgedWeights(mesh, bones, options, table, progress);
}

}  // namespace limber
