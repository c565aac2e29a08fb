// The curve skeleton: extracting it from growing models, its parts, and another number of joints on it.
#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/rigging/curve_skeleton/contraction.h"
#include "limber/rigging/curve_skeleton/curve_skeleton.h"
#include "limber/rigging/curve_skeleton/even_surface.h"

namespace limber::bench {

namespace {

CurveSkeleton curvesOf(const TriMesh& mesh) {
  Progress progress;
  return CurveSkeleton::build(mesh, progress);
}

void extractFrom(benchmark::State& state, const TriMesh& mesh) {
  for (auto _ : state) benchmark::DoNotOptimize(curvesOf(mesh));
  state.counters["vertices"] = mesh.vertexCount();
}

void curveSkeletonExtract(benchmark::State& state) {
  extractFrom(state, creature(static_cast<Index>(state.range(0))));
}
void curveSkeletonExtractSymmetric(benchmark::State& state) {
  extractFrom(state, creature(static_cast<Index>(state.range(0)), true));
}
void curveSkeletonExtractPieces(benchmark::State& state) {
  extractFrom(state, swarm(static_cast<Index>(state.range(0))));
}

// The sampling alone: what grows with the model.
void curveSkeletonSample(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  const CollapseFrame frame = CollapseFrame::of(mesh, std::nullopt);
  for (auto _ : state) benchmark::DoNotOptimize(evenSurface(mesh, frame, false));
}

// The contraction alone, of so many vertices as they are.
void curveSkeletonContract(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(contractSurface(mesh, progress));
  }
}

// Another number of joints on curves that are known.
void curveSkeletonLevel(benchmark::State& state) {
  const CurveSkeleton curves = curvesOf(creature(20000));
  for (auto _ : state) benchmark::DoNotOptimize(curves.level(static_cast<Index>(state.range(0))));
}

BENCHMARK(curveSkeletonExtract)
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(curveSkeletonExtractSymmetric)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(curveSkeletonExtractPieces)->Arg(20000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(curveSkeletonSample)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(curveSkeletonContract)->Arg(1000)->Arg(4000)->Arg(16000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(curveSkeletonLevel)->Arg(20)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace limber::bench
