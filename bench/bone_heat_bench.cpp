// Bone heat against its floor, the factorisation and the solves alone done with Eigen, and its parts one by one.
#include <algorithm>
#include <map>
#include <utility>

#include <benchmark/benchmark.h>
#include <Eigen/SparseCholesky>

#include "bench_meshes.h"
#include "limber/core/parallel.h"
#include "limber/core/progress.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/solve/laplacian.h"
#include "limber/geometry/solve/sparse_cholesky.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/bone_heat.h"
#include "limber/rigging/weights/heat_sources.h"

namespace limber::bench {

namespace {

struct Model {
  TriMesh mesh;
  std::vector<Bone> bones;
};

std::vector<Bone> handlesOf(const TriMesh& mesh, Index count) {
  Progress progress;
  RigOptions options;
  options.handles = count;
  return bonesOf(findRigger("sphere-mesh").rig(mesh, options, progress).skeleton);
}

Model creatureWithHandles(const benchmark::State& state) {
  Model model;
  model.mesh = creature(static_cast<Index>(state.range(0)));
  model.bones = handlesOf(model.mesh, static_cast<Index>(state.range(1)));
  return model;
}

struct HeatEquation {
  Eigen::SparseMatrix<double> matrix;  // its lower triangle
  Eigen::MatrixXd right;               // a column for each joint that holds a vertex
};

HeatEquation equationOf(const Model& model) {
  Laplacian laplacian = robustLaplacian(model.mesh, vertexComponents(model.mesh));
  const Bvh bvh(model.mesh);
  const HeatSources sources = findHeatSources(model.mesh, model.bones, &bvh, BoneHeatOptions{}.sources);
  std::map<Index, int> columnOf;
  for (const Index joint : sources.joints) columnOf.emplace(joint, 0);
  int columns = 0;
  for (auto& [joint, column] : columnOf) column = columns++;
  HeatEquation equation{std::move(laplacian.stiffness), Eigen::MatrixXd::Zero(model.mesh.vertexCount(), columns)};
  for (Index v = 0; v < model.mesh.vertexCount(); ++v) {
    for (const Index joint : sources.jointsOf(v)) {
      equation.right(v, columnOf[joint]) = laplacian.mass[v] * sources.pull[v];
      equation.matrix.coeffRef(static_cast<int>(v), static_cast<int>(v)) += laplacian.mass[v] * sources.pull[v];
    }
  }
  return equation;
}

// One solve for each joint, spread over the threads. Returns the seconds it took.
double solveWithEigen(const HeatEquation& equation, Eigen::MatrixXd& weights) {
  const double start = secondsNow();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(equation.matrix);
  parallelFor(static_cast<std::size_t>(equation.right.cols()), 1, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index j = static_cast<Eigen::Index>(begin); j < static_cast<Eigen::Index>(end); ++j) {
      weights.col(j) = factor.solve(equation.right.col(j));
    }
  });
  return secondsNow() - start;
}

// The whole of bone heat. `floor_ms` is Eigen's factorisation and solves of the same equation, measured in turns with
// it, the best of each; `to_floor` their quotient.
void boneHeat(benchmark::State& state) {
  const Model model = creatureWithHandles(state);
  const HeatEquation equation = equationOf(model);
  Eigen::MatrixXd weights(equation.right.rows(), equation.right.cols());
  double best = 1e9, floor = 1e9;
  for (auto _ : state) {
    const double start = secondsNow();
    Progress progress;
    benchmark::DoNotOptimize(boneHeatWeights(model.mesh, model.bones, {}, progress));
    const double seconds = secondsNow() - start;
    state.SetIterationTime(seconds);
    best = std::min(best, seconds);
    floor = std::min(floor, solveWithEigen(equation, weights));
  }
  state.counters["vertices"] = model.mesh.vertexCount();
  state.counters["floor_ms"] = 1e3 * floor;
  state.counters["to_floor"] = best / floor;
}

// Without the floor, whose factor alone would take most of the time: a million vertices.
void boneHeatLarge(benchmark::State& state) {
  const Model model = creatureWithHandles(state);
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(boneHeatWeights(model.mesh, model.bones, {}, progress));
  }
  state.counters["vertices"] = model.mesh.vertexCount();
}

void heatLaplacian(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  const std::vector<Index> piece = vertexComponents(mesh);
  for (auto _ : state) benchmark::DoNotOptimize(robustLaplacian(mesh, piece));
}

void heatBvhBuild(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(Bvh(mesh));
}

void heatSight(benchmark::State& state) {
  const Model model = creatureWithHandles(state);
  const Bvh bvh(model.mesh);
  for (auto _ : state) {
    benchmark::DoNotOptimize(findHeatSources(model.mesh, model.bones, &bvh, BoneHeatOptions{}.sources));
  }
}

void heatFactorPlan(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  const Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  for (auto _ : state) benchmark::DoNotOptimize(SparseCholesky(laplacian.stiffness).factorEntries());
}

void heatFactor(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  laplacian.stiffness.diagonal() += laplacian.mass;
  SparseCholesky cholesky(laplacian.stiffness);
  for (auto _ : state) benchmark::DoNotOptimize(cholesky.factorize(laplacian.stiffness));
}

// Eight right-hand sides, one thread.
void heatSolve(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  laplacian.stiffness.diagonal() += laplacian.mass;
  SparseCholesky cholesky(laplacian.stiffness);
  cholesky.factorize(laplacian.stiffness);
  std::vector<double> x(mesh.positions.size() * SparseCholesky::kColumns);
  for (auto _ : state) {
    std::fill(x.begin(), x.end(), 1.0);
    cholesky.solve(x.data());
    benchmark::DoNotOptimize(x.data());
  }
}

BENCHMARK(boneHeat)
    ->Args({5500, 20})
    ->Args({5500, 100})
    ->Args({10000, 20})
    ->Args({20000, 20})
    ->Args({20000, 100})
    ->Args({50000, 20})
    ->Args({50000, 100})
    ->Args({147000, 20})
    ->Args({147000, 100})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK(boneHeatLarge)->Args({1000000, 50})->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

void growingSizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(10000)->Arg(50000)->Arg(147000)->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK(heatLaplacian)->Apply(growingSizes);
BENCHMARK(heatBvhBuild)->Apply(growingSizes);
BENCHMARK(heatFactorPlan)->Apply(growingSizes);
BENCHMARK(heatFactor)->Apply(growingSizes);
BENCHMARK(heatSolve)->Apply(growingSizes);
BENCHMARK(heatSight)
    ->Args({10000, 20})
    ->Args({50000, 20})
    ->Args({147000, 20})
    ->Args({147000, 100})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

}  // namespace limber::bench
