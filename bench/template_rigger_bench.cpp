// The template rigger over growing models: measuring the body, and the whole fit of a template by name and of the
// likeliest.
#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/core/progress.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/template_rigger.h"

namespace limber::bench {

namespace {

void measure(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)), true);
  for (auto _ : state) benchmark::DoNotOptimize(measureBody(mesh));
  state.counters["vertices"] = mesh.vertexCount();
}

void fit(benchmark::State& state, const char* name) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)), true);
  RigOptions options;
  options.templateName = name;
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(rigWithTemplate(mesh, options, progress));
  }
  state.counters["vertices"] = mesh.vertexCount();
}

void growing(benchmark::internal::Benchmark* bench) {
  for (const std::int64_t vertices : {10000, 100000, 1000000}) bench->Arg(vertices);
  bench->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(measure)->Name("templateMeasureBody")->Apply(growing);
BENCHMARK_CAPTURE(fit, humanoid, "humanoid")->Name("templateRigHumanoid")->Apply(growing);
BENCHMARK_CAPTURE(fit, automatic, "auto")->Name("templateRigAuto")->Apply(growing);

}  // namespace

}  // namespace limber::bench
