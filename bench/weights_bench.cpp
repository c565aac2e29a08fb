// Every method of making weights, over growing surfaces and numbers of bones.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/core/progress.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/weight_method.h"

namespace limber::bench {

namespace {

// The bones of a skeleton inside the creature, which has the same shape with any number of vertices.
std::vector<Bone> bonesOfCreature(Index count) {
  RigOptions options;
  options.handles = count;
  Progress progress;
  Skeleton skeleton = findRigger("sphere-mesh").rig(creature(5000), options, progress).skeleton;
  skeleton.boneShape = BoneShape::kSegment;
  return bonesOf(skeleton);
}

void makeWeights(benchmark::State& state, const WeightMethod& method) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  const std::vector<Bone> bones = bonesOfCreature(static_cast<Index>(state.range(1)));
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(method.compute(mesh, bones, {}, progress));
  }
  state.counters["vertices"] = mesh.vertexCount();
}

const bool kWeightsRegistered = [] {
  for (const WeightMethod& method : weightMethods()) {
    benchmark::RegisterBenchmark(("weights/" + std::string(method.name)).c_str(),
                                 [&method](benchmark::State& state) { makeWeights(state, method); })
        ->ArgsProduct({{1000, 10000, 50000}, {10, 20, 50}})
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  return true;
}();

}  // namespace

}  // namespace limber::bench
