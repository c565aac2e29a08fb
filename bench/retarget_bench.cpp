// Frames a second of the retargeting methods onto a skeleton of 60 joints, on one thread.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "limber/core/rotation.h"
#include "limber/motion/retarget/motion_smoothing.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace {

using namespace limber;

// Every joint swings a little; thigh and shin against each other, so that feet come and go.
PoseSequence swinging(const Skeleton& person) {
  PoseSequence motion;
  for (int f = 0; f < 120; ++f) {
    Pose pose = restPose(person);
    for (Index j = 1; j < person.jointCount(); ++j) {
      const double phase = 0.1 * f + j;
      pose.locals[j].rotation = fromRotationVector(0.3 * Vec3(std::sin(phase), std::cos(1.3 * phase), 0));
    }
    motion.poses.push_back(pose);
  }
  return motion;
}

Skeleton withShortShins(Skeleton person) {
  for (Joint& joint : person.joints) {
    if (joint.name.find("LowerLeg") != std::string::npos) joint.rest.translation *= 0.8;
  }
  return person;
}

void retargetFrame(benchmark::State& state, const std::string& method) {
  const Skeleton source = practiceHumanoid(), target = withShortShins(source);
  const PoseSequence motion = swinging(source);
  const RetargetSetup setup(source, target, matchSkeletons(source, target), {}, &motion);
  const auto retargeter = findRetargetMethod(method).make(setup);
  Pose pose = restPose(target);
  std::size_t frame = 0;
  for (auto _ : state) {
    retargeter->next(motion.poses[frame], frame == 0 ? 0 : motion.frameSeconds, pose);
    benchmark::DoNotOptimize(pose.locals.data());
    frame = (frame + 1) % motion.poses.size();
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(retargetFrame, aligned, "aligned");
BENCHMARK_CAPTURE(retargetFrame, limb_ik, "limb-ik");

// A whole motion. The floor is a pass of forward kinematics over source and target, which is all that an even one
// costs, as by joint angles alone. Legs with short shins that are solved for are rough, these so much that smoothing
// goes 24 rounds with 68 least squares of 9 unknowns a frame: half the time, each 0.7 us a frame for 4600 products.
void smoothing(benchmark::State& state, const std::string& method) {
  const Skeleton source = practiceHumanoid(), target = withShortShins(source);
  const PoseSequence motion = swinging(source);
  RetargetOptions options;
  options.smoothMotion = false;
  const RetargetSetup setup(source, target, matchSkeletons(source, target), options, &motion);
  const PoseSequence moved = retargetFrames(findRetargetMethod(method), setup, motion);
  for (auto _ : state) {
    PoseSequence smoothed = moved;
    smoothMotion(setup, motion, smoothed);
    benchmark::DoNotOptimize(smoothed.poses.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(motion.poses.size()));
}

BENCHMARK_CAPTURE(smoothing, even, "aligned");
BENCHMARK_CAPTURE(smoothing, rough, "limb-ik");

// The same from the source on.
void retargetMotion(benchmark::State& state, const std::string& method) {
  const Skeleton source = practiceHumanoid(), target = withShortShins(source);
  const PoseSequence motion = swinging(source);
  const RetargetSetup setup(source, target, matchSkeletons(source, target), {}, &motion);
  for (auto _ : state) {
    const PoseSequence moved = retargetFrames(findRetargetMethod(method), setup, motion);
    benchmark::DoNotOptimize(moved.poses.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(motion.poses.size()));
}

BENCHMARK_CAPTURE(retargetMotion, rough, "limb-ik");

}  // namespace
