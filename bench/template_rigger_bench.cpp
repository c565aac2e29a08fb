// The template rigger over growing models: measuring the body, and the whole fit of each template.
#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/core/progress.h"
#include "limber/rigging/figure/figure_search.h"
#include "limber/rigging/figure/testing/figure_body.h"
#include "limber/rigging/template_rigger.h"

namespace limber::bench {

namespace {

void measure(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)), true);
  for (auto _ : state) benchmark::DoNotOptimize(measureBody(mesh));
  state.counters["vertices"] = mesh.vertexCount();
}

void fit(benchmark::State& state, const TriMesh& mesh, const char* name) {
  RigOptions options;
  options.templateName = name;
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(rigWithTemplate(mesh, options, progress));
  }
  state.counters["vertices"] = mesh.vertexCount();
}

void fitCreature(benchmark::State& state, const char* name) {
  fit(state, creature(static_cast<Index>(state.range(0)), true), name);
}

// Found as a figure only after its embedding is in doubt: the slowest path through the rigger.
void fitStatue(benchmark::State& state) {
  fit(state, statue(static_cast<Index>(state.range(0))), "humanoid");
}

void figure(benchmark::State& state) {
  const BodyVolume body = measureBody(testing::statueOf(testing::crouchingFigure()));
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(findFigure(body, {}, progress));
  }
}

void growing(benchmark::internal::Benchmark* bench) {
  for (const std::int64_t vertices : {10000, 100000, 1000000}) bench->Arg(vertices);
  bench->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(measure)->Name("templateMeasureBody")->Apply(growing);
BENCHMARK(figure)->Name("templateFindFigure")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(fitCreature, humanoid, "humanoid")->Name("templateRigHumanoid")->Apply(growing);
BENCHMARK_CAPTURE(fitCreature, automatic, "auto")->Name("templateRigAuto")->Apply(growing);
BENCHMARK(fitStatue)->Name("templateRigStatue")->Apply(growing);

}  // namespace

}  // namespace limber::bench
