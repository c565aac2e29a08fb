// Bones and weights out of moving meshes of growing size: points, frames and bones one after the other.
#include <algorithm>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/rigging/decomposition/bone_weights.h"
#include "limber/rigging/decomposition/motion_clusters.h"
#include "limber/rigging/decomposition/motion_fit.h"
#include "limber/rigging/decomposition/skin_decomposition.h"

namespace limber::bench {

namespace {

// A creature that is moved by bones in a row along its longest side, with weights that pass smoothly from one to the
// next; each bone turns by itself.
VertexSequence movingCreature(Index points, Index frames, Index bones) {
  const TriMesh mesh = creature(points);
  Box box;
  for (const Vec3f& p : mesh.positions) box.add(p.cast<double>());
  int axis = 0;
  box.size().maxCoeff(&axis);
  VertexSequence sequence(mesh.vertexCount(), frames);
  sequence.rest = mesh.positions;
  for (Index f = 0; f < frames; ++f) {
    std::vector<Affine> moved;
    for (Index b = 0; b < bones; ++b) {
      Vec3 center = box.center();
      center[axis] = box.min[axis] + (b + 0.5) / bones * box.size()[axis];
      const Vec3 turnAxis = Vec3(std::sin(1.0 + b), std::cos(2.0 * b), 0.5).normalized();
      moved.push_back(Eigen::Translation3d(center) * Affine(Eigen::AngleAxisd(0.4 * std::sin(0.2 * f + b), turnAxis)) *
                      Eigen::Translation3d(-center));
    }
    for (Index v = 0; v < sequence.pointCount(); ++v) {
      const Vec3 p = mesh.positions[v].cast<double>();
      const double position = (p[axis] - box.min[axis]) / box.size()[axis] * bones - 0.5;
      const double lower = std::min(std::max(std::floor(position), 0.0), bones - 1.0);
      const double fraction = std::min(std::max(position - lower, 0.0), 1.0);
      const auto b = static_cast<Index>(lower);
      const Vec3 blended = (1 - fraction) * (moved[b] * p) + fraction * (moved[std::min(b + 1, bones - 1)] * p);
      sequence.set(v, f, blended.cast<float>());
    }
  }
  return sequence;
}

VertexSequence sequenceOf(const benchmark::State& state) {
  return movingCreature(static_cast<Index>(state.range(0)), static_cast<Index>(state.range(1)),
                        static_cast<Index>(state.range(2)));
}

void decomposition(benchmark::State& state) {
  const VertexSequence sequence = sequenceOf(state);
  DecompositionOptions options;
  options.bones = static_cast<Index>(state.range(2));
  double error = 0;
  for (auto _ : state) {
    Progress progress;
    error = decomposeSkin(sequence, options, progress).error;
  }
  state.counters["error_percent"] = 100 * error;
}

void decompositionClusters(benchmark::State& state) {
  const VertexSequence sequence = sequenceOf(state);
  Progress progress;
  for (auto _ : state) {
    benchmark::DoNotOptimize(motionClusters(sequence, static_cast<Index>(state.range(2)), progress));
  }
}

void decompositionWeights(benchmark::State& state) {
  const VertexSequence sequence = sequenceOf(state);
  Progress progress;
  const BoneMotions motions = motionClusters(sequence, static_cast<Index>(state.range(2)), progress).motions;
  for (auto _ : state) benchmark::DoNotOptimize(fitWeights(sequence, motions, 4, {}));
}

void decompositionMotions(benchmark::State& state) {
  const VertexSequence sequence = sequenceOf(state);
  Progress progress;
  BoneMotions motions = motionClusters(sequence, static_cast<Index>(state.range(2)), progress).motions;
  const SkinWeights weights = fitWeights(sequence, motions, 4, {}).weights;
  for (auto _ : state) fitMotions(sequence, weights, motions);
}

void growingSequences(benchmark::internal::Benchmark* bench) {
  bench->Args({5000, 60, 20})
      ->Args({20000, 60, 20})
      ->Args({80000, 60, 20})
      ->Args({5000, 240, 20})
      ->Args({5000, 60, 80})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}
BENCHMARK(decomposition)->Apply(growingSequences);
BENCHMARK(decompositionClusters)->Apply(growingSequences);
BENCHMARK(decompositionWeights)->Apply(growingSequences);
BENCHMARK(decompositionMotions)->Apply(growingSequences);

}  // namespace

}  // namespace limber::bench
