#include "limber/skinning/bounded_biharmonic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "limber/core/parallel.h"
#include "limber/mesh/signed_distance.h"
#include "limber/skinning/bone_distance.h"
#include "limber/skinning/inside_lattice.h"
#include "limber/skinning/lattice_biharmonic.h"
#include "limber/skinning/weight_steps.h"

namespace limber {

namespace {

constexpr double kFirstNodes = 2e4;  // of the grid that tells how much of it is inside
constexpr double kSurely = 0.2;      // of the way to other bones: from there on weights begin at 1
constexpr Index kJointsAtOnce = 16;  // between looks at whether to go on

// A lattice with about as many cells as are asked for: the first grid tells how many a finer one will have.
InsideLattice latticeOf(const BoundedBiharmonicOptions& biharmonic, const TriMesh& mesh) {
  const InsideQueries queries(mesh);
  const Index first = cellsForNodes(mesh, kFirstNodes, InsideLattice::kLeastCells, biharmonic.mostCells);
  InsideLattice lattice(mesh, queries, first);
  const double finer = std::cbrt(biharmonic.cells / std::max<Index>(1, lattice.cellCount()));
  const Index second =
      static_cast<Index>(std::clamp<double>(first * finer, InsideLattice::kLeastCells, biharmonic.mostCells));
  return second == first ? std::move(lattice) : InsideLattice(mesh, queries, second);
}

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

// What is held where bones pass: by cell, for each joint that has a part of it.
struct HeldCells {
  struct Part {
    Index cell;
    double part;
  };
  std::vector<Index> joints;             // ascending: those that hold any cell
  std::vector<std::vector<Part>> parts;  // by joint of these; cells ascending
  std::vector<bool> held;                // by cell
};

HeldCells holdCells(InsideLattice& lattice, std::span<const Bone> bones) {
  std::map<Index, std::map<Index, double>> byJoint;  // how many places of its bones lie in a cell
  for (Bone bone : bones) {
    bone.radius = 0;
    for (const Index cell : lattice.cellsAlong(bone)) byJoint[bone.joint][cell] += 1;
  }
  std::vector<double> all(lattice.cellCount(), 0);
  for (const auto& [joint, cells] : byJoint) {
    for (const auto& [cell, places] : cells) all[cell] += places;
  }
  HeldCells result;
  for (const auto& [joint, cells] : byJoint) {
    result.joints.push_back(joint);
    result.parts.emplace_back();
    for (const auto& [cell, places] : cells) result.parts.back().push_back({cell, places / all[cell]});
  }
  for (const double places : all) result.held.push_back(places > 0);
  return result;
}

// By node: the fewest edges to one of some; kNoIndex where there is no way.
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

// Where the descent begins: what the weights of a bar between two bones are, by the ways to the joint's own cells and
// to those of others.
std::vector<double> firstWeights(const LatticeGraph& graph, const HeldCells& cells, std::size_t joint) {
  std::vector<double> part(graph.nodeCount(), 0);
  std::vector<Index> own, others;
  for (const HeldCells::Part& held : cells.parts[joint]) {
    part[held.cell] = held.part;
    own.push_back(held.cell);
  }
  for (Index node = 0; node < graph.nodeCount(); ++node) {
    if (cells.held[node] && part[node] < 1) others.push_back(node);
  }
  const std::vector<Index> toOwn = edgesFrom(graph, own), toOthers = edgesFrom(graph, others);
  for (Index node = 0; node < graph.nodeCount(); ++node) {
    if (cells.held[node] || toOwn[node] == kNoIndex) continue;
    const double along = toOthers[node] == kNoIndex ? 1 : toOthers[node] / (1.0 * toOthers[node] + toOwn[node]);
    const double t = std::clamp((along - kSurely) / (1 - 2 * kSurely), 0.0, 1.0);
    part[node] = t * t * (3 - 2 * t);
  }
  return part;
}

// The weights of all joints at the cells of a lattice: cells' rows, a column for each joint that holds any.
std::vector<float> solveJoints(const LatticeGraph& graph, const HeldCells& cells, double tolerance,
                               Progress& progress) {
  const std::size_t joints = cells.joints.size();
  std::vector<float> weights(graph.nodeCount() * joints);
  BiharmonicOptions options;
  options.tolerance = tolerance;
  for (std::size_t first = 0; first < joints; first += kJointsAtOnce) {
    progress.update(static_cast<double>(first) / static_cast<double>(joints));
    parallelFor(std::min<std::size_t>(kJointsAtOnce, joints - first), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = first + begin; j < first + end; ++j) {
        std::vector<double> w = firstWeights(graph, cells, j);
        minimizeBoundedBiharmonic(graph, cells.held, w, options);
        for (std::size_t node = 0; node < w.size(); ++node) weights[node * joints + j] = static_cast<float>(w[node]);
      }
    });
  }
  return weights;
}

InfluenceTable sampleAtVertices(const TriMesh& mesh, const InsideLattice& lattice, const std::vector<Index>& joints,
                                const std::vector<float>& weights, Index slots) {
  InfluenceTable table(mesh.vertexCount(), slots);
  parallelFor(mesh.vertexCount(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sums(joints.size());
    for (std::size_t v = begin; v < end; ++v) {
      std::array<Index, 8> cells;
      std::array<double, 8> parts;
      const int count = lattice.cellsRound(mesh.position(static_cast<Index>(v)), cells, parts);
      std::fill(sums.begin(), sums.end(), 0.0);
      for (int i = 0; i < count; ++i) {
        const float* row = weights.data() + cells[i] * joints.size();
        for (std::size_t j = 0; j < joints.size(); ++j) sums[j] += parts[i] * row[j];
      }
      for (std::size_t j = 0; j < joints.size(); ++j) table.offer(v, joints[j], static_cast<float>(sums[j]));
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
  progress.step("lattice");
  InsideLattice lattice = latticeOf(biharmonic, mesh);
  const HeldCells cells = holdCells(lattice, bones);

  progress.step("smoothest weights");
  const std::vector<float> weights = solveJoints(graphOf(lattice), cells, biharmonic.tolerance, progress);

  progress.step("weights");
  InfluenceTable table = sampleAtVertices(mesh, lattice, cells.joints, weights, options.maxInfluences);
  return bridgedWeights(mesh, bones, options, table, progress);
}

}  // namespace limber
