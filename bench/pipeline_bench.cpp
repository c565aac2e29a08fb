// The stages together: the table of the thesis that limber goes back to, weld to weights, and the program as a whole.
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>

#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "bench_models.h"
#include "limber/core/progress.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/weight_method.h"

namespace limber::bench {

namespace {

struct Phases {
  double weld = 0, rig = 0, skin = 0;  // seconds
};

Phases rigAndSkin(const TriMesh& source, Index handles) {
  Progress progress;
  const double start = secondsNow();
  const PreparedMesh prepared = prepareMesh(source.positions, source.triangles);
  const double welded = secondsNow();
  RigOptions options;
  options.handles = handles;
  const AutoRig rig = findRigger("sphere-mesh").rig(prepared.mesh, options, progress);
  const double rigged = secondsNow();
  const std::vector<Bone> bones = bonesOf(rig.skeleton);
  const WeightResult weights = findWeightMethod("bone-heat").compute(prepared.mesh, bones, {}, progress);
  benchmark::DoNotOptimize(weights.weights.weights.data());
  return {welded - start, rigged - welded, secondsNow() - rigged};
}

template <typename Model>
void weldToWeights(benchmark::State& state, Model&& model) {
  const TriMesh mesh = model(static_cast<Index>(state.range(0)));
  Phases sum;
  for (auto _ : state) {
    const Phases phases = rigAndSkin(mesh, static_cast<Index>(state.range(1)));
    sum.weld += phases.weld;
    sum.rig += phases.rig;
    sum.skin += phases.skin;
  }
  const double toMilliseconds = 1e3 / static_cast<double>(state.iterations());
  state.counters["vertices"] = mesh.vertexCount();
  state.counters["weld_ms"] = sum.weld * toMilliseconds;
  state.counters["rig_ms"] = sum.rig * toMilliseconds;
  state.counters["skin_ms"] = sum.skin * toMilliseconds;
}

// Makes the model in a process of its own: a process's peak memory counts as that of those that it starts.
bool writeModelApart(Index vertices, const std::string& path) {
  const pid_t child = fork();
  if (child == 0) {
    writeMeshGlb(creature(vertices), path);
    _exit(0);
  }
  int status = 1;
  return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

// `limber rig` with its reading and writing, started anew each time.
void wholeProcess(benchmark::State& state) {
  const auto folder = std::filesystem::temp_directory_path() / "limber_bench";
  std::filesystem::create_directories(folder);
  const std::string input = folder / "model.glb", output = folder / "rigged.glb";
  const std::string handles = std::to_string(state.range(1));
  if (!writeModelApart(static_cast<Index>(state.range(0)), input)) state.SkipWithError("no model could be written");
  const char* arguments[] = {LIMBER_PROGRAM, "rig",          input.c_str(), "--handles", handles.c_str(),
                             "-o",           output.c_str(), "--quiet",     nullptr};
  double peak = 0;
  for (auto _ : state) {
    pid_t child = 0;
    int status = 1;
    rusage usage{};
    if (posix_spawn(&child, LIMBER_PROGRAM, nullptr, nullptr, const_cast<char**>(arguments), environ) != 0 ||
        wait4(child, &status, 0, &usage) != child || status != 0) {
      state.SkipWithError("the program did not run");
      break;
    }
    peak = std::max(peak, static_cast<double>(usage.ru_maxrss) / 1024);
  }
  state.counters["peak_MB"] = peak;
  std::filesystem::remove_all(folder);
}

void thesisCounts(benchmark::internal::Benchmark* bench, std::int64_t vertices) {
  for (const std::int64_t bones : {6, 10, 20, 50, 100}) bench->Args({vertices, bones});
  bench->ArgNames({"", "bones"})->Unit(benchmark::kMillisecond)->UseRealTime();
}

void growingModels(benchmark::internal::Benchmark* bench) {
  for (const std::int64_t vertices : {5000, 10000, 20000, 50000, 150000, 500000, 1000000})
    bench->Args({vertices, vertices < 500000 ? 20 : 50});
  bench->ArgNames({"", "handles"})->Unit(benchmark::kMillisecond)->UseRealTime();
}

}  // namespace

const auto kCreature = [](Index vertices) { return creature(vertices); };

BENCHMARK_CAPTURE(weldToWeights, robot, robot)->Name("thesis_robot")->Apply([](auto* b) { thesisCounts(b, 5000); });
BENCHMARK_CAPTURE(weldToWeights, creature, kCreature)->Name("thesis_creature")->Apply([](auto* b) {
  thesisCounts(b, 10000);
});
BENCHMARK_CAPTURE(weldToWeights, growing, kCreature)->Name("weld_to_weights")->Apply(growingModels);
BENCHMARK(wholeProcess)->Name("process_limber_rig")->Apply(growingModels);

}  // namespace limber::bench
