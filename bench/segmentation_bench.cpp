// Parts of growing models: by shape, by weights, the flow that cuts them, and the caps that close them.
#include <algorithm>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/actions/parts/part_caps.h"
#include "limber/actions/parts/shape_parts.h"
#include "limber/actions/parts/weight_parts.h"

namespace limber::bench {

namespace {

void partsOfShape(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(partsByShape(mesh, {}, progress));
  }
  state.counters["triangles"] = mesh.triangleCount();
}

// Ten joints along the longest side, each fading into the next.
SkinWeights fadingWeights(const TriMesh& mesh) {
  SkinWeights weights;
  weights.slots = 2;
  for (const Vec3f& p : mesh.positions) {
    const float at = std::clamp((p.x() + 0.5f) * 9, 0.0f, 8.999f), lower = std::floor(at);
    weights.joints.insert(weights.joints.end(), {static_cast<Index>(lower), static_cast<Index>(lower) + 1});
    weights.weights.insert(weights.weights.end(), {1 - (at - lower), at - lower});
  }
  return weights;
}

JointGroups tenGroups() {
  JointGroups groups;
  for (Index j = 0; j < 10; ++j) {
    groups.groupOf.push_back(j);
    groups.names.push_back("joint_" + std::to_string(j));
  }
  return groups;
}

void partsOfWeights(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  const SkinWeights weights = fadingWeights(mesh);
  const JointGroups groups = tenGroups();
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(partsByWeights(faceGraph(mesh), mesh.triangles, weights, groups, progress));
  }
  state.counters["triangles"] = mesh.triangleCount();
}

void capsOfParts(benchmark::State& state) {
  const TriMesh mesh = creature(static_cast<Index>(state.range(0)));
  Progress progress;
  const SurfaceParts parts =
      partsByWeights(faceGraph(mesh), mesh.triangles, fadingWeights(mesh), tenGroups(), progress);
  for (auto _ : state) benchmark::DoNotOptimize(capParts(mesh, parts.partOf, parts.partCount(), progress));
  state.counters["triangles"] = mesh.triangleCount();
}

BENCHMARK(partsOfShape)->Arg(2500)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(partsOfWeights)->Arg(2500)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(capsOfParts)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

}  // namespace limber::bench
