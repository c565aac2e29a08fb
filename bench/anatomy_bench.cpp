// Reading bodies: what every match, template and session asks first. 0.2 ms for 100 joints is imperceptible even for a
// folder of characters; the floor is the features' table, one row for each folded joint and guess of the axes.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "limber/character/anatomy/anatomy.h"

namespace limber {
namespace {

Index addJoint(Skeleton& skeleton, std::optional<Index> parent, const Vec3& offset) {
  Joint joint;
  joint.name = fmt::format("joint_{:02}", skeleton.jointCount());
  joint.parent = parent;
  joint.rest.translation = offset;
  skeleton.joints.push_back(joint);
  return skeleton.jointCount() - 1;
}

Index addChain(Skeleton& skeleton, std::optional<Index> parent, const Vec3& step, int joints) {
  for (int i = 0; i < joints; ++i) parent = addJoint(skeleton, parent, step);
  return *parent;
}

// A person with names that say nothing: legs, arms, a head and, below each hand, five fingers; 60 joints. `tails` more
// chains of ten joints each hang on the hips.
Skeleton person(int tails) {
  Skeleton skeleton;
  const Index hips = addJoint(skeleton, {}, {0, 1, 0});
  const Index chest = addChain(skeleton, hips, {0, 0.15, 0}, 3);
  addChain(skeleton, chest, {0, 0.12, 0}, 2);
  for (const double x : {1.0, -1.0}) {
    const Index knee = addChain(skeleton, addJoint(skeleton, hips, {0.1 * x, -0.05, 0}), {0, -0.45, 0}, 2);
    addJoint(skeleton, knee, {0, -0.05, 0.12});
    const Index shoulder = addJoint(skeleton, chest, {0.03 * x, 0.08, 0});
    const Index wrist = addChain(skeleton, addJoint(skeleton, shoulder, {0.14 * x, 0, 0}), {0.27 * x, 0, 0}, 2);
    for (int finger = 0; finger < 5; ++finger) {
      const Index knuckle = addJoint(skeleton, wrist, {0.08 * x, 0, 0.02 * (finger - 2)});
      addChain(skeleton, knuckle, {0.03 * x, 0, 0}, 3);
    }
  }
  for (int t = 0; t < tails; ++t) addChain(skeleton, hips, {0, -0.02, -0.05 - 0.01 * t}, 10);
  return skeleton;
}

void readPerson(benchmark::State& state) {
  const Skeleton skeleton = person(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(readAnatomy(skeleton));
  state.counters["joints"] = static_cast<double>(skeleton.jointCount());
}
BENCHMARK(readPerson)->Arg(0)->Arg(4)->Unit(benchmark::kMillisecond);

void readDeepTree(benchmark::State& state) {
  Skeleton skeleton;
  addChain(skeleton, {}, {0, 0.01, 0}, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(readAnatomy(skeleton));
}
BENCHMARK(readDeepTree)->Arg(1000)->Arg(8000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limber
