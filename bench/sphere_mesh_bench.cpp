// The sphere mesh: recording the whole collapse over growing models, and reading a level off it.
#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/rigging/sphere_mesh/handle_tree.h"
#include "limber/rigging/sphere_mesh_rigger.h"

namespace limber::bench {

namespace {

void build(benchmark::State& state, const TriMesh& mesh) {
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(SphereMesh::build(mesh, progress));
  }
  state.counters["vertices"] = mesh.vertexCount();
  state.counters["us_per_vertex"] = benchmark::Counter(
      mesh.vertexCount() * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sphereMeshRecord(benchmark::State& state) {
  build(state, creature(static_cast<Index>(state.range(0))));
}
void sphereMeshRecordSymmetric(benchmark::State& state) {
  build(state, creature(static_cast<Index>(state.range(0)), true));
}
void sphereMeshRecordPieces(benchmark::State& state) {
  build(state, swarm(static_cast<Index>(state.range(0))));
}

// Another count of handles, as a skeleton, off a recorded collapse: arguments are vertices and handles.
void sphereMeshReadLevel(benchmark::State& state) {
  Progress progress;
  const SphereMesh spheres = SphereMesh::build(creature(static_cast<Index>(state.range(0))), progress);
  for (auto _ : state) benchmark::DoNotOptimize(handleSkeleton(spheres, static_cast<Index>(state.range(1))));
}

BENCHMARK(sphereMeshRecord)
    ->Arg(5000)
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(50000)
    ->Arg(147000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(sphereMeshRecordSymmetric)->Arg(20000)->Arg(50000)->Arg(147000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(sphereMeshRecordPieces)->Arg(20000)->Arg(147000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(sphereMeshReadLevel)
    ->Args({50000, 6})
    ->Args({50000, 20})
    ->Args({50000, 100})
    ->Args({50000, 1000})
    ->Args({1000000, 100})
    ->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace limber::bench
