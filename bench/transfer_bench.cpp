// A rig onto another body: the same creature with other proportions, over growing sources and targets.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bench_meshes.h"
#include "limber/rigging/transfer/rig_transfer.h"

namespace limber::bench {

namespace {

// Joints along the creature's longest side, each holding what is nearest to it.
RiggedBody riggedCreature(Index vertices) {
  RiggedBody body;
  body.mesh = creature(vertices, true);
  constexpr Index kJoints = 20;
  for (Index j = 0; j < kJoints; ++j) {
    Joint joint;
    joint.name = "joint_" + std::to_string(j);
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = j > 0 ? Vec3(1.0 / kJoints, 0, 0) : Vec3(-0.5, 0, 0);
    body.skeleton.joints.push_back(joint);
  }
  body.weights.slots = 1;
  for (const Vec3f& p : body.mesh.positions) {
    const double along = std::clamp((p.x() + 0.5) * kJoints, 0.0, kJoints - 1.0);
    body.weights.joints.push_back(static_cast<Index>(along));
    body.weights.weights.push_back(1);
  }
  return body;
}

// Thicker towards one end and a little bent.
Vec3 otherBody(const Vec3& p) {
  return {1.1 * p.x(), (1 + 0.2 * p.x()) * p.y() + 0.05 * p.x() * p.x(), 0.9 * p.z()};
}

void transfer(benchmark::State& state) {
  const RiggedBody source = riggedCreature(static_cast<Index>(state.range(0)));
  TriMesh target = creature(static_cast<Index>(state.range(1)), true);
  for (Vec3f& p : target.positions) p = otherBody(p.cast<double>()).cast<float>();
  std::vector<JointLandmark> landmarks;
  const std::vector<Affine> globals = restGlobals(source.skeleton);
  for (Index j = 0; j < globals.size(); ++j) landmarks.push_back({j, otherBody(globals[j].translation())});
  for (auto _ : state) {
    Progress progress;
    benchmark::DoNotOptimize(transferRig(source, landmarks, target, {}, progress));
  }
}

BENCHMARK(transfer)
    ->Name("transferRig")
    ->Args({5000, 15000})
    ->Args({15000, 50000})
    ->Args({50000, 150000})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

}  // namespace limber::bench
