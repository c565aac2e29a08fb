#include "limber/skeleton/ik/solvers/leap.h"

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

// A chain bent by `angle` at every joint, its tip's target where it would be bent by `wanted`.
struct Bent {
  Skeleton chain = straightChain(6, 1);
  std::vector<IkTarget> targets{1};

  Pose bentBy(double angle) const {
    Pose pose = restPose(chain);
    for (Transform& local : pose.locals) local.rotation = fromRotationVector(Vec3(angle, 0, 0));
    return pose;
  }
  explicit Bent(double wanted) {
    targets[0].joint = 5;
    targets[0].position = poseGlobals(chain, bentBy(wanted))[5].translation();
  }
};

void bendOn(IkSystem& system, double angle) {
  for (Quat& local : system.locals) local = fromRotationVector(Vec3(angle, 0, 0)) * local;
  system.forward();
}

TEST(Leap, GoesOnInTheDirectionOfTheSweep) {
  const Bent bent(0.5);
  IkSystem system(bent.chain, bent.targets, nullptr, {});
  system.load(bent.bentBy(0.1), bent.targets);
  Leap leap(system);
  double cost = system.cost();
  int sweeps = 0;
  for (; !system.allReached() && sweeps < 40; ++sweeps) {
    leap.mark(system);
    bendOn(system, 0.01);
    const double swept = system.cost();
    const double leapt = leap.take(system);
    EXPECT_LE(leapt, swept);
    EXPECT_DOUBLE_EQ(leapt, system.cost());
    if (system.cost() > cost) break;  // beyond the target, where the sweep itself goes wrong
    cost = system.cost();
  }
  EXPECT_LT(sweeps, 15) << "40 sweeps of a hundredth, without leaps";
}

TEST(Leap, DoesNotLeapWhereThatGainsNothing) {
  const Bent bent(0.5);
  IkSystem system(bent.chain, bent.targets, nullptr, {});
  system.load(bent.bentBy(0.49), bent.targets);
  Leap leap(system);
  leap.mark(system);
  bendOn(system, 0.01);
  const std::vector<Quat> there = system.locals;
  leap.take(system);
  for (std::size_t n = 0; n < there.size(); ++n) EXPECT_EQ(system.locals[n].coeffs(), there[n].coeffs());
}

TEST(Leap, TheFurthestIsHeededMost) {
  const Skeleton humanoid = practiceHumanoid();
  std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
  targets[1].weight = 2;
  IkSystem system(humanoid, targets, nullptr, {});
  targets[0].position += Vec3(0, 0.3, 0);
  targets[1].position += Vec3(0, 0.3, 0);
  targets[2].position += Vec3(0, 0.1, 0);
  system.load(restPose(humanoid), targets);
  std::vector<double> weights(targets.size());
  heedTheFurthest(system, weights);
  EXPECT_DOUBLE_EQ(weights[1], 2 * weights[0]);
  EXPECT_LT(weights[2], weights[0]);
  EXPECT_LT(weights[4], weights[2]);
  EXPECT_GT(weights[4], 0);

  system.load(restPose(humanoid), practiceHumanoidTargets(humanoid));
  heedTheFurthest(system, weights);
  for (const double weight : weights) EXPECT_GT(weight, 0);
}

}  // namespace
}  // namespace limber
