// Inverse kinematics: the analytic limb, the methods on chains of growing length, and a whole body from frame to frame.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/ik_task.h"
#include "limber/skeleton/ik/solvers/two_bone.h"

namespace limber {
namespace {

// Reachable targets spread over directions and distances, the same for every method.
std::vector<Vec3> targetsWithin(double length) {
  std::vector<Vec3> targets;
  for (int i = 0; i < 256; ++i) {
    const double height = 2 * (i + 0.5) / 256 - 1, angle = i * 2.399963;  // a Fibonacci lattice on the sphere
    const double ring = std::sqrt(1 - height * height), distance = length * (0.2 + 0.7 * ((i * 37) % 256) / 256.0);
    targets.push_back(distance * Vec3(ring * std::cos(angle), height, ring * std::sin(angle)));
  }
  return targets;
}

void twoBone(benchmark::State& state) {
  const std::vector<Vec3> targets = targetsWithin(0.55);
  TwoBone bones{Vec3(0, 0, 0), Vec3(0.3, 0.01, 0), Vec3(0.55, 0, 0.02), Vec3::Zero(), Vec3(0.2, 1, 0.1)};
  std::size_t i = 0;
  for (auto _ : state) {
    bones.target = targets[i++ % targets.size()];
    benchmark::DoNotOptimize(solveTwoBone(bones));
  }
}
BENCHMARK(twoBone);

// From the slightly bent rest pose to each target, to a millionth of the length.
void chain(benchmark::State& state, const char* method) {
  const auto joints = static_cast<Index>(state.range(0));
  const Skeleton skeleton = straightChain(joints, 0.9);
  Pose rest = restPose(skeleton);
  for (Transform& local : rest.locals) local.rotation = fromRotationVector(Vec3(0.05, 0, 0.05));
  const std::vector<Vec3> positions = targetsWithin(0.9);
  std::vector<IkTarget> targets(1);
  targets[0].joint = joints - 1;
  IkOptions options;
  options.tolerance = 1e-6;
  IkSolver solver(findIkMethod(method), skeleton, targets, nullptr, options);
  std::size_t i = 0, reached = 0;
  double iterations = 0;
  Pose pose = rest;
  for (auto _ : state) {
    for (Index j = 0; j < joints; ++j) pose.locals[j].rotation = rest.locals[j].rotation;
    targets[0].position = positions[i++ % positions.size()];
    const IkResult& result = solver.solve(pose, targets);
    reached += result.reached();
    iterations += result.iterations;
  }
  state.counters["iterations"] = iterations / static_cast<double>(i);
  state.counters["reached"] = static_cast<double>(reached) / static_cast<double>(i);
}
BENCHMARK_CAPTURE(chain, fabrik, "fabrik")->Arg(3)->Arg(10)->Arg(30)->Arg(100);
BENCHMARK_CAPTURE(chain, ccd, "ccd")->Arg(3)->Arg(10)->Arg(30)->Arg(100);
BENCHMARK_CAPTURE(chain, ccdForward, "ccd-forward")->Arg(10);
BENCHMARK_CAPTURE(chain, transpose, "jacobian-transpose")->Arg(10);
BENCHMARK_CAPTURE(chain, pseudoInverse, "pseudo-inverse")->Arg(10);
BENCHMARK_CAPTURE(chain, dls, "dls")->Arg(3)->Arg(10)->Arg(30)->Arg(100);
BENCHMARK_CAPTURE(chain, sdls, "sdls")->Arg(10);
BENCHMARK_CAPTURE(chain, particle, "particle")->Arg(3)->Arg(10)->Arg(30)->Arg(100);
BENCHMARK_CAPTURE(chain, massSpring, "mass-spring")->Arg(3)->Arg(10)->Arg(30)->Arg(100);

// Hands, feet and head of 60 joints follow circles at walking pace, 60 frames a second. With the root fixed, the head's
// target is further than the spine is long in 10 of 60 frames: 0.83 is all that can be reached.
void wholeBody(benchmark::State& state, RootMotion rootMotion) {
  const Skeleton humanoid = practiceHumanoid();
  const std::vector<IkTarget> rest = practiceHumanoidTargets(humanoid);
  IkOptions options;
  options.restarts = 0;
  options.tolerance = 1e-3;
  options.rootMotion = rootMotion;
  IkSolver solver(findIkMethod("whole-body"), humanoid, rest, nullptr, options);
  Pose pose = restPose(humanoid);
  std::vector<IkTarget> targets = rest;
  int frame = 0;
  double iterations = 0, reached = 0;
  for (auto _ : state) {
    const double phase = 2 * kPi * frame++ / 60;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const double a = phase + static_cast<double>(t);
      const Vec3 inwards = 0.1 * (Vec3(0, 1, 0) - rest[t].position);
      targets[t].position = rest[t].position + inwards + 0.06 * Vec3(0, std::sin(a), std::cos(a));
    }
    const IkResult& result = solver.solve(pose, targets);
    iterations += result.iterations;
    reached += result.reached();
  }
  state.counters["iterations"] = iterations / frame;
  state.counters["reached"] = reached / frame;
}
BENCHMARK_CAPTURE(wholeBody, rootFixed, RootMotion::kFixed);
BENCHMARK_CAPTURE(wholeBody, rootMoves, RootMotion::kTranslate);

// A chain that bends to a point from one frame to the next, round a sphere as an obstacle: grows with the joints.
void tasksOfChain(benchmark::State& state) {
  const auto joints = static_cast<Index>(state.range(0));
  const Skeleton skeleton = straightChain(joints, 0.9);
  Pose pose = restPose(skeleton);
  for (Transform& local : pose.locals) local.rotation = fromRotationVector(Vec3(0.05, 0, 0.05));
  const std::vector<Vec3> positions = targetsWithin(0.9);
  IkTaskOptions options;
  options.ik.restarts = 0;
  std::size_t i = 0;
  double met = 0;
  for (auto _ : state) {
    Pose answer = pose;
    const Vec3 target = positions[i++ % positions.size()], middle = 0.5 * target;
    const std::vector<IkTask> tasks = {{PositionTask{joints - 1, target}, 1, 1},
                                       {KeepOutTask{joints / 2, middle, middle, 0.1}}};
    met += solveIkTasks(skeleton, answer, tasks, nullptr, options).met();
  }
  state.counters["met"] = met / static_cast<double>(i);
}
BENCHMARK(tasksOfChain)->Arg(3)->Arg(10)->Arg(30)->Arg(100);

// On 60 joints, from rest pose: the first 1, 2, ... of a list.
void tasksOfHumanoid(benchmark::State& state) {
  const Skeleton humanoid = practiceHumanoid();
  const auto joint = [&](const char* name) { return humanoid.find(name).value(); };
  const std::vector<Vec3> rest = posePositions(humanoid, restPose(humanoid));
  const Index leftFoot = joint("leftFoot"), rightFoot = joint("rightFoot");
  std::vector<IkTask> tasks = {
      {PositionTask{joint("leftHand"), Vec3(0.3, 1.3, 0.35)}, 1, 1},
      {LookAtTask{joint("head"), Vec3(0.5, 1.2, 1), Vec3::UnitZ()}, 1, 2},
      {PositionTask{leftFoot, rest[leftFoot]}},
      {PositionTask{rightFoot, rest[rightFoot]}},
      {KeepOutTask{joint("rightHand"), Vec3(-0.6, 1.3, 0), Vec3(-0.6, 1.3, 0), 0.2}, 1, 1},
      {BalanceTask{{leftFoot, rightFoot, joint("leftToes"), joint("rightToes")}}, 1, 1},
      {CouplingTask{joint("neck"), joint("head"), 0.5}, 1, 3},
      {PlaneTask{joint("rightLowerArm"), Vec3::UnitY(), 1.2}, 1, 2},
  };
  tasks.resize(static_cast<std::size_t>(state.range(0)));
  IkTaskOptions options;
  options.ik.restarts = 0;
  options.ik.rootMotion = RootMotion::kTranslate;
  std::size_t met = 0, solves = 0;
  for (auto _ : state) {
    Pose pose = restPose(humanoid);
    met += solveIkTasks(humanoid, pose, tasks, nullptr, options).met();
    ++solves;
  }
  state.counters["met"] = static_cast<double>(met) / static_cast<double>(solves);
}
BENCHMARK(tasksOfHumanoid)->Arg(1)->Arg(2)->Arg(4)->Arg(6)->Arg(8);

}  // namespace
}  // namespace limber
