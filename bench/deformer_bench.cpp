// Deformers on one thread. Of those that need no surface, nanoseconds a vertex with four influences and 100 joints,
// over growing meshes; of all on creatures bound by bone heat, frames and what is prepared once.
#include <random>

#include <benchmark/benchmark.h>

#include "bench_meshes.h"
#include "limber/core/parallel.h"
#include "limber/core/progress.h"
#include "limber/deform/centers_of_rotation.h"
#include "limber/deform/direct_delta_mush.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/skeleton/pose.h"

namespace {

using namespace limber;

constexpr Index kJoints = 100;

struct Character {
  std::vector<Vec3f> positions, normals;
  SkinWeights weights;
  std::vector<Affine> transforms;
  RotationCenters rotationCenters;
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
    result.rotationCenters.centers.push_back(vector());
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
  std::vector<float> scratch(deformer.scratchSize(bound.positions.size(), kJoints));
  std::vector<Vec3f> positions(bound.positions.size()), turned(normals ? bound.normals.size() : 0);
  const DeformInput input = {bound.positions,       bound.normals, bound.weights, bound.transforms, {},
                             &bound.rotationCenters};
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

// A creature with 40 handles, each turned by up to half a right angle.
struct BoundCreature {
  TriMesh mesh;
  SkinWeights weights;
  std::vector<Affine> transforms;

  Index jointCount() const { return static_cast<Index>(transforms.size()); }
  std::shared_ptr<const DeformPreparation> prepared(const Deformer& deformer) const {
    return prepareDeformer(deformer, {mesh.positions, mesh.triangles, weights}, jointCount());
  }
};

BoundCreature boundCreature(const benchmark::State& state) {
  BoundCreature result;
  result.mesh = bench::creature(static_cast<Index>(state.range(0)));
  Progress progress;
  RigOptions options;
  options.handles = 40;
  const Skeleton skeleton = findRigger("sphere-mesh").rig(result.mesh, options, progress).skeleton;
  result.weights = findWeightMethod("bone-heat").compute(result.mesh, bonesOf(skeleton), {}, progress).weights;
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const Vec3& joint : restPositions(skeleton)) {
    const Eigen::AngleAxisd turn(0.8 * uniform(generator), Vec3::UnitY());
    result.transforms.push_back(Affine(Eigen::Translation3d(joint) * turn * Eigen::Translation3d(-joint)));
  }
  return result;
}

// One deformer on a creature, ready for frames.
class CreatureFrames {
 public:
  CreatureFrames(const BoundCreature& creature, const char* name)
      : CreatureFrames(creature, findDeformer(name), creature.prepared(findDeformer(name))) {}
  CreatureFrames(const BoundCreature& creature, const Deformer& deformer,
                 std::shared_ptr<const DeformPreparation> prepared)
      : creature_(creature),
        deformer_(deformer),
        prepared_(std::move(prepared)),
        scratch_(deformer_.scratchSize(creature.mesh.positions.size(), creature.jointCount())),
        positions_(creature.mesh.positions.size()) {}

  // Seconds of a frame.
  double run() {
    const double start = secondsNow();
    deformer_.deform({creature_.mesh.positions, {}, creature_.weights, creature_.transforms, {}, prepared_.get()},
                     {positions_, {}}, scratch_);
    benchmark::DoNotOptimize(positions_.data());
    return secondsNow() - start;
  }

  // Of the last frames of both, in thousandths of the longest side, least first.
  std::vector<double> distancesTo(const CreatureFrames& other) const {
    Box box;
    for (const Vec3f& position : creature_.mesh.positions) box.add(position.cast<double>());
    std::vector<double> distances;
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      distances.push_back(1000 * static_cast<double>((positions_[v] - other.positions_[v]).norm()) / box.longestSide());
    }
    std::sort(distances.begin(), distances.end());
    return distances;
  }

 private:
  const BoundCreature& creature_;
  const Deformer& deformer_;
  std::shared_ptr<const DeformPreparation> prepared_;
  std::vector<float> scratch_;
  std::vector<Vec3f> positions_;
};

// The floor is linear blend of the same creature; `floor_us` is measured in turns, the best of each, `to_floor` the
// quotient, and `to_dual_quaternion` that to dual quaternions.
void deformCreature(benchmark::State& state, const char* name) {
  setThreadCount(1);
  const BoundCreature creature = boundCreature(state);
  CreatureFrames own(creature, name), linear(creature, "linear-blend"), dual(creature, "dual-quaternion");
  double best = 1e9, floor = 1e9, turned = 1e9;
  for (auto _ : state) {
    const double seconds = own.run();
    state.SetIterationTime(seconds);
    best = std::min(best, seconds);
    floor = std::min(floor, linear.run());
    turned = std::min(turned, dual.run());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * creature.mesh.positions.size()));
  state.counters["floor_us"] = 1e6 * floor;
  state.counters["to_floor"] = best / floor;
  state.counters["to_dual_quaternion"] = best / turned;
  setThreadCount(0);
}

// Direct delta mush with fewer joints: what a frame costs against dual quaternions, measured in turns, and how far
// vertices lie from where all joints move them, in thousandths of the longest side.
void directWithFewerJoints(benchmark::State& state) {
  setThreadCount(1);
  const BoundCreature creature = boundCreature(state);
  DirectDeltaMushOptions options, all;
  options.maxJoints = static_cast<Index>(state.range(1));
  options.minEntry = 1e-3 * static_cast<double>(state.range(2));
  all.minWeight = 1.0 / 256;
  all.maxJoints = creature.jointCount();
  all.minEntry = 0;
  const BoundSurface surface = {creature.mesh.positions, creature.mesh.triangles, creature.weights};
  const auto rows = directDeltaMushRows(surface, creature.jointCount(), options);
  CreatureFrames own(creature, findDeformer("direct-delta-mush"), rows), dual(creature, "dual-quaternion");
  CreatureFrames whole(creature, findDeformer("direct-delta-mush"),
                       directDeltaMushRows(surface, creature.jointCount(), all));
  double best = 1e9, turned = 1e9;
  for (auto _ : state) {
    const double seconds = own.run();
    state.SetIterationTime(seconds);
    best = std::min(best, seconds);
    turned = std::min(turned, dual.run());
  }
  whole.run();
  const std::vector<double> off = own.distancesTo(whole);
  state.counters["to_dual_quaternion"] = best / turned;
  state.counters["entries"] = static_cast<double>(rows->joints.size()) / 4 / static_cast<double>(rows->rowOf.size());
  state.counters["off_p95"] = off[off.size() * 95 / 100];
  state.counters["off_most"] = off.back();
  setThreadCount(0);
}

void prepareCreature(benchmark::State& state, const char* name) {
  setThreadCount(1);
  const BoundCreature creature = boundCreature(state);
  const Deformer& deformer = findDeformer(name);
  for (auto _ : state) benchmark::DoNotOptimize(creature.prepared(deformer));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * creature.mesh.positions.size()));
  setThreadCount(0);
}

void overCreatures(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(4)->Range(5000, 80000)->Unit(benchmark::kMicrosecond);
}

void overCreaturesInTurns(benchmark::internal::Benchmark* bench) {
  overCreatures(bench);
  bench->UseManualTime();
}

BENCHMARK_CAPTURE(deformCreature, linearBlend, "linear-blend")->Apply(overCreaturesInTurns);
BENCHMARK_CAPTURE(deformCreature, dualQuaternion, "dual-quaternion")->Apply(overCreaturesInTurns);
BENCHMARK_CAPTURE(deformCreature, centersOfRotation, "centers-of-rotation")->Apply(overCreaturesInTurns);
BENCHMARK_CAPTURE(deformCreature, deltaMush, "delta-mush")->Apply(overCreaturesInTurns);
BENCHMARK_CAPTURE(deformCreature, directDeltaMush, "direct-delta-mush")->Apply(overCreaturesInTurns);
BENCHMARK(directWithFewerJoints)
    ->ArgsProduct({{20000}, {4, 8}, {0, 31, 50}})
    ->Unit(benchmark::kMicrosecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(prepareCreature, centersOfRotation, "centers-of-rotation")->Apply(overCreatures);
BENCHMARK_CAPTURE(prepareCreature, deltaMush, "delta-mush")->Apply(overCreatures);
BENCHMARK_CAPTURE(prepareCreature, directDeltaMush, "direct-delta-mush")->Apply(overCreatures);

}  // namespace
