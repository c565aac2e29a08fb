// Many effectors: priorities, the moving root, the secondary task, and that nothing is allocated meanwhile.
#include "limber/skeleton/ik/solvers/whole_body.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Counts what the whole test program takes from the heap. Kept out of line: with one of a pair inlined, g++ sees memory
// of the other's given to free().
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace limber {
namespace {

class WholeBodyTest : public ::testing::Test {
 protected:
  Pose solve(const char* method, const std::vector<IkTarget>& wanted, const IkOptions& options = {}) {
    Pose pose = restPose(humanoid);
    result = solveIk(findIkMethod(method), humanoid, pose, wanted, nullptr, options);
    return pose;
  }

  Vec3 position(const Pose& pose, const char* joint) const {
    return poseGlobals(humanoid, pose)[humanoid.find(joint).value()].translation();
  }

  Skeleton humanoid = practiceHumanoid();
  std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
  IkResult result;
};

TEST_F(WholeBodyTest, TheFirstPriorityIsMetWhereTargetsConflict) {
  std::vector<IkTarget> two = {targets[0], targets[1]};  // both hands further apart than the arms are long
  two[0].position = Vec3(0.82, 1.3, 0.2);
  two[1].position = Vec3(-0.82, 1.3, 0.2);
  for (const char* method : {"dls", "pseudo-inverse", "sdls", "whole-body"}) {
    for (const int first : {0, 1}) {
      two[0].priority = first;
      two[1].priority = 1 - first;
      IkOptions options;
      options.maxIterations = 500;
      options.rootMotion = RootMotion::kFixed;
      solve(method, two, options);
      const auto winner = static_cast<std::size_t>(first == 0 ? 0 : 1);
      EXPECT_LT(result.targets[winner].distance, 2e-3) << method;
      EXPECT_GT(result.targets[1 - winner].distance, 0.05) << method;
    }
  }
}

TEST_F(WholeBodyTest, TheRootMovesOnlyWhereAllowed) {
  for (IkTarget& target : targets) target.position += Vec3(0.4, -0.1, 0.5);
  IkOptions options;
  for (const char* method : {"whole-body", "dls", "ccd", "fabrik"}) {
    options.rootMotion = RootMotion::kTranslate;
    const Pose moved = solve(method, targets, options);
    for (const IkTargetResult& target : result.targets) EXPECT_LT(target.distance, 0.02) << method;
    EXPECT_GT((moved.locals[0].translation - humanoid.joints[0].rest.translation).norm(), 0.1);
    options.rootMotion = RootMotion::kFixed;
    const Pose fixed = solve(method, targets, options);
    EXPECT_EQ(fixed.locals[0].translation, humanoid.joints[0].rest.translation);
    EXPECT_EQ(fixed.locals[0].rotation.coeffs(), humanoid.joints[0].rest.rotation.coeffs());
    EXPECT_FALSE(result.reached()) << method;
  }
}

TEST_F(WholeBodyTest, SymmetricTargetsGiveSymmetricPoses) {
  targets[0].position += Vec3(-0.2, 0.3, 0.2);
  targets[1].position += Vec3(0.2, 0.3, 0.2);
  targets[2].position += Vec3(0, 0.2, 0.1);
  targets[3].position += Vec3(0, 0.2, 0.1);
  for (const IkMethod& method : ikMethods()) {
    if (method.name == "two-bone") continue;
    IkOptions options;
    options.restarts = 0;
    Pose pose = restPose(humanoid);
    solveIk(method, humanoid, pose, targets, nullptr, options);
    for (const char* joint : {"Shoulder", "UpperArm", "LowerArm", "UpperLeg", "LowerLeg", "Foot"}) {
      const Quat left = pose.locals[humanoid.find(std::string("left") + joint).value()].rotation;
      const Quat right = pose.locals[humanoid.find(std::string("right") + joint).value()].rotation;
      EXPECT_LT(angleBetween(left, Quat(right.w(), right.x(), -right.y(), -right.z())), 1e-9) << method.name << joint;
    }
  }
}

// Of the poses that reach, the secondary task finds one nearer to the reference.
TEST_F(WholeBodyTest, TheNullSpaceComesNearerToTheReference) {
  const Skeleton chain = straightChain(8, 1);
  std::vector<IkTarget> tip(1);
  tip[0].joint = 7;
  tip[0].position = Vec3(0.3, 0.5, 0.2);
  Pose bent = restPose(chain);
  for (Transform& local : bent.locals) local.rotation = fromRotationVector(Vec3(0.25, 0, -0.1));
  const auto distance = [&](const Pose& pose) {
    double sum = 0;
    for (Index j = 0; j < 8; ++j) {
      const double angle = angleBetween(pose.locals[j].rotation, bent.locals[j].rotation);
      sum += angle * angle;
    }
    return sum;
  };
  for (const char* method : {"jacobian-transpose", "pseudo-inverse", "dls", "sdls", "whole-body"}) {
    Pose start = restPose(chain);
    for (Transform& local : start.locals) local.rotation = fromRotationVector(Vec3(-0.4, 0.2, 0.3));
    Pose without = start, with = start;
    IkOptions options;
    EXPECT_TRUE(solveIk(findIkMethod(method), chain, without, tip, nullptr, options).reached());
    options.referenceGain = 0.3;
    options.reference = bent;
    EXPECT_TRUE(solveIk(findIkMethod(method), chain, with, tip, nullptr, options).reached()) << method;
    EXPECT_LT(distance(with), 0.5 * distance(without)) << method;
  }
}

TEST_F(WholeBodyTest, SolvingTakesNoMemory) {
  const JointLimits limits = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
  targets[0].orientation = Quat::Identity();
  targets[4].priority = 1;
  for (const IkMethod& method : ikMethods()) {
    std::vector<IkTarget> wanted = targets;
    if (method.name == "two-bone") {
      wanted.resize(4);
      for (IkTarget& target : wanted) target.base = humanoid.joints[*humanoid.joints[target.joint].parent].parent;
    }
    for (const JointLimits* some : {static_cast<const JointLimits*>(nullptr), &limits}) {
      IkOptions options;
      options.maxIterations = 20;
      options.restarts = 2;
      options.referenceGain = 0.1;
      options.rootMotion = RootMotion::kTranslate;
      IkSolver solver(method, humanoid, wanted, some, options);
      Pose pose = restPose(humanoid);
      for (IkTarget& target : wanted) target.position += Vec3(0.05, 0.1, 0.1);
      const std::size_t before = allocations;
      solver.solve(pose, wanted);
      EXPECT_EQ(allocations, before) << method.name;
    }
  }
}

// Joints at their limits too: a hand on a slow circle, with the arm's limits, no restarts.
TEST_F(WholeBodyTest, DraggingWithLimitsDoesNotFlip) {
  const JointLimits limits = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
  for (const IkMethod& method : ikMethods()) {
    std::vector<IkTarget> hand = {targets[0]};
    hand[0].base = humanoid.find("leftUpperArm").value();
    IkOptions options;
    options.restarts = 0;
    IkSolver solver(method, humanoid, hand, &limits, options);
    Pose pose = restPose(humanoid);
    for (int i = 0; i < 100; ++i) {  // from the T-pose to the front
      hand[0].position = Vec3(0.6 - 0.0028 * i, 1.38 - 0.0015 * i, 0.003 * i);
      solver.solve(pose, hand);
    }
    double largest = 0;
    for (int step = 0; step <= 1000; ++step) {
      const Pose before = pose;
      const double a = 2 * kPi * step / 1000;
      hand[0].position = Vec3(0.31 + 0.08 * std::sin(a), 1.2 + 0.04 * std::cos(2 * a), 0.3 + 0.04 * std::sin(a));
      solver.solve(pose, hand);
      for (Index j = 0; j < humanoid.jointCount() && step > 0; ++j) {
        EXPECT_LT(limitViolation(limits.joints[j], pose.locals[j].rotation), 1e-4);
        largest = std::max(largest, angleBetween(before.locals[j].rotation, pose.locals[j].rotation));
      }
    }
    EXPECT_LT(largest, 0.06) << method.name;
  }
}

}  // namespace
}  // namespace limber
