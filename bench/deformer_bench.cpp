// Deformers on one thread: nanoseconds a vertex with four influences and 100 joints, over growing meshes.
#include <random>

#include <benchmark/benchmark.h>

#include "limber/core/parallel.h"
#include "limber/skinning/deformer.h"

namespace {

using namespace limber;

constexpr Index kJoints = 100;

struct Character {
  std::vector<Vec3f> positions, normals;
  SkinWeights weights;
  std::vector<Affine> transforms;
  std::vector<Vec3f> rotationCenters;
};

// Vertices in order along a chain, each bound to four neighbouring joints, as meshes of real characters mostly are.
Character character(Index vertices, bool scaled) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto vector = [&] { return Vec3f(uniform(generator), uniform(generator), uniform(generator)); };
  Character result;
  result.weights.slots = 4;
  for (Index v = 0; v < vertices; ++v) {
    result.positions.push_back(vector());
    result.normals.push_back(vector().normalized());
    result.rotationCenters.push_back(vector());
    const Index first = static_cast<Index>(std::size_t{v} * kJoints / vertices);
    for (Index slot = 0; slot < 4; ++slot) result.weights.joints.push_back((first + slot) % kJoints);
    result.weights.weights.insert(result.weights.weights.end(), {0.5f, 0.25f, 0.15f, 0.1f});
  }
  for (Index j = 0; j < kJoints; ++j) {
    Affine map(Eigen::Translation3d(vector().cast<double>()) *
               Eigen::AngleAxisd(2.0 * uniform(generator), Vec3::UnitY()));
    if (scaled) map = map * Eigen::Scaling(1.0, 1.2, 0.9);
    result.transforms.push_back(map);
  }
  return result;
}

void deform(benchmark::State& state, const char* name, bool normals, bool scaled) {
  setThreadCount(1);
  const Character bound = character(static_cast<Index>(state.range(0)), scaled);
  const Deformer& deformer = findDeformer(name);
  std::vector<float> scratch(deformer.scratchSize(kJoints));
  std::vector<Vec3f> positions(bound.positions.size()), turned(normals ? bound.normals.size() : 0);
  const DeformInput input = {bound.positions,      bound.normals, bound.weights, bound.transforms, {},
                             bound.rotationCenters};
  for (auto _ : state) {
    deformer.deform(input, {positions, turned}, scratch);
    benchmark::DoNotOptimize(positions.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * state.range(0));
  setThreadCount(0);
}

BENCHMARK_CAPTURE(deform, linearBlend, "linear-blend", false, false)->RangeMultiplier(4)->Range(5000, 80000);
BENCHMARK_CAPTURE(deform, linearBlendNormals, "linear-blend", true, false)->Arg(20000);
BENCHMARK_CAPTURE(deform, dualQuaternion, "dual-quaternion", false, false)->RangeMultiplier(4)->Range(5000, 80000);
BENCHMARK_CAPTURE(deform, dualQuaternionNormals, "dual-quaternion", true, false)->Arg(20000);
BENCHMARK_CAPTURE(deform, dualQuaternionScaled, "dual-quaternion", false, true)->Arg(20000);
BENCHMARK_CAPTURE(deform, centersOfRotation, "centers-of-rotation", false, false)
    ->RangeMultiplier(4)
    ->Range(5000, 80000);
BENCHMARK_CAPTURE(deform, centersOfRotationNormals, "centers-of-rotation", true, false)->Arg(20000);
BENCHMARK_CAPTURE(deform, centersOfRotationScaled, "centers-of-rotation", false, true)->Arg(20000);

}  // namespace
