// Tasks: derivatives against differences, closed forms, priorities, what cannot be met.
#include "limber/skeleton/ik/ik_task.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/rotation.h"
#include "limber/core/text/numbers.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/ik_task_rows.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"
#include "limber/skeleton/ik/solvers/jacobian.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

class IkTaskTest : public ::testing::Test {
 protected:
  Index joint(const char* name) const { return humanoid.find(name).value(); }
  Vec3 position(const Pose& pose, const char* name) const { return posePositions(humanoid, pose)[joint(name)]; }
  Quat rotation(const Pose& pose, const char* name) const {
    return decompose(poseGlobals(humanoid, pose)[joint(name)]).rotation;
  }
  IkTaskResult solve(std::vector<IkTask> tasks, Pose& pose, const JointLimits* limits = nullptr) const {
    return solveIkTasks(humanoid, pose, tasks, limits, options);
  }

  std::vector<IkTask> oneOfEach() const {
    const Index hand = joint("leftHand"), head = joint("head"), foot = joint("rightFoot");
    std::vector<IkTask> tasks;
    tasks.push_back({PositionTask{hand, Vec3(0.3, 1.2, 0.3)}});
    tasks.push_back({OrientationTask{head, fromRotationVector(Vec3(0.2, 0.5, -0.3))}, 2.5});
    tasks.push_back({LookAtTask{head, Vec3(1, 1.5, 2), Vec3(0.6, 0, 0.8)}});
    tasks.push_back({DistanceTask{hand, joint("rightHand"), 0.2}, 0.7, 1});
    tasks.push_back({DistanceTask{foot, Vec3(0.1, 0.5, 0.2), 0.4}, 1, 2});
    tasks.push_back({PlaneTask{foot, Vec3(0, 0.6, 0.8), 5, true}, 1, 1});
    tasks.push_back({PlaneTask{hand, Vec3(1, 0, 0), 0.1, false}});
    tasks.push_back({BalanceTask{{foot, joint("leftFoot"), joint("leftToes"), joint("rightToes")}, false}, 1, 3});
    tasks.push_back({BalanceTask{{foot, joint("leftFoot")}, false}, 1, 3});
    tasks.push_back({BalanceTask{{foot}, true}, 1, 3});
    tasks.push_back({KeepOutTask{hand, Vec3(0.5, 1.2, 0), Vec3(0.5, 1.2, 0), 3}});
    tasks.push_back({KeepOutTask{hand, Vec3(0, 1, 0), Vec3(0.3, 1.5, 0.1), 3}});
    tasks.push_back({CouplingTask{joint("neck"), head, 0.5}});
    tasks.push_back({CouplingTask{joint("rightLowerArm"), joint("leftLowerArm"), -1}});
    return tasks;
  }

  Skeleton humanoid = practiceHumanoid();
  IkTaskOptions options;
};

void bendAtRandom(IkSystem& system, RandomValues& random, double fraction) {
  for (std::size_t n = 0; n < system.nodes.size(); ++n) {
    system.locals[n] = system.locals[n].slerp(fraction, random.rotation());
  }
  system.forward();
}

// Central differences along each column, of all rows that are active or not.
TEST_F(IkTaskTest, RowsAreDerivatives) {
  RandomValues random(1);
  const std::vector<IkTask> tasks = oneOfEach();
  options.masses = {{joint("head"), Vec3(0, 0.1, 0.02), 4},
                    {joint("hips"), Vec3(0, 0, 0.1), 30},
                    {joint("leftLowerLeg"), Vec3(0, -0.2, 0), 5}};
  options.ik.rootMotion = RootMotion::kTranslate;
  IkTaskRows rows(humanoid, tasks, options);
  IkSystem system(humanoid, rows, nullptr, options.ik);
  for (int pose = 0; pose < 4; ++pose) {
    system.load(restPose(humanoid), {});
    bendAtRandom(system, random, 0.4);
    IkJacobian jacobian(system, std::vector<double>(system.nodes.size(), 0.7));
    jacobian.build(system);
    IkSystem::State start = system.makeState();
    const auto residualAt = [&](const Eigen::VectorXd& step) {
      for (int n = 0; n < system.nodeCount(); ++n) {
        const auto i = static_cast<std::size_t>(n);
        system.locals[i] = system.locals[i] * fromRotationVector(jacobian.turnOf(n, step));
        system.offsets[i] += jacobian.slideOf(n, step);
      }
      system.forward();
      // Inequalities that hold count as 0: their rows are compared where they are violated.
      rows.measure(system, true);
      Eigen::VectorXd residual(jacobian.rows());
      for (Eigen::Index r = 0; r < residual.size(); ++r) residual[r] = rows.residual(r);
      system.restore(start);
      return residual;
    };
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(jacobian.maxColumns());
    residualAt(none);
    std::vector<bool> active;
    for (Eigen::Index r = 0; r < jacobian.rows(); ++r) active.push_back(rows.active(r));
    constexpr double kStep = 1e-5;
    for (Eigen::Index c = 0; c < jacobian.columns(); ++c) {
      Eigen::VectorXd step = none;
      step[c] = kStep;
      const Eigen::VectorXd slope = (residualAt(-step) - residualAt(step)) / (2 * kStep);
      for (Eigen::Index r = 0; r < jacobian.rows(); ++r) {
        if (!active[static_cast<std::size_t>(r)]) continue;
        EXPECT_NEAR(slope[r], jacobian.matrix(r, c), 2e-6) << "row " << r << ", column " << c;
      }
    }
  }
}

TEST_F(IkTaskTest, AHeadTurnsToWhereItLooks) {
  RandomValues random(2);
  Skeleton single;
  single.joints.push_back({"eye", {}, {}});
  single.joints[0].rest.translation = Vec3(0.1, 0.2, 0.3);
  options.ik.angleTolerance = 1e-9;
  for (int i = 0; i < 200; ++i) {
    Pose pose = restPose(single);
    pose.locals[0].rotation = random.rotation();
    const Vec3 axis = random.direction(), wanted = random.direction();
    // Straight behind it, too.
    const Vec3 target = i == 0 ? Vec3(pose.locals[0].translation - pose.locals[0].rotation * axis)
                               : Vec3(pose.locals[0].translation + random.uniform(0.5, 3) * wanted);
    const IkTask task{LookAtTask{0, target, axis}};
    const IkTaskResult result = solveIkTasks(single, pose, {&task, 1}, nullptr, options);
    EXPECT_TRUE(result.met());
    const Vec3 look = pose.locals[0].rotation * axis;
    EXPECT_LT((look - (target - pose.locals[0].translation).normalized()).norm(), 1e-8);
  }
}

// Two bones of 0.5 m with the tip at a distance from the base: the law of cosines tells the angle between.
TEST_F(IkTaskTest, DistanceBendsTwoBonesByTheLawOfCosines) {
  const Skeleton arm = straightChain(3, 1);
  options.ik.tolerance = 1e-10;
  for (const double distance : {0.1, 0.4, 0.8, 0.99}) {
    Pose pose = restPose(arm);
    pose.locals[1].rotation = fromRotationVector(Vec3(0.4, 0, 0));
    const IkTask task{DistanceTask{2, Index{0}, distance}};
    EXPECT_TRUE(solveIkTasks(arm, pose, {&task, 1}, nullptr, options).met());
    const double cosine = (2 * 0.25 - distance * distance) / (2 * 0.25);
    EXPECT_NEAR(angleBetween(pose.locals[1].rotation, Quat::Identity()), kPi - std::acos(cosine), 1e-6);
  }
  Pose pose = restPose(arm);
  const IkTask far{DistanceTask{2, Index{0}, 1.5}};
  const IkTaskResult result = solveIkTasks(arm, pose, {&far, 1}, nullptr, options);
  EXPECT_EQ(result.tasks[0].obstacle, IkTaskObstacle::kTooFar);
  EXPECT_NEAR(result.tasks[0].residual, 0.5, 1e-6);
}

TEST_F(IkTaskTest, KeepOutPushesToTheSurfaceAndNoFurther) {
  options.ik.tolerance = 1e-9;
  Pose pose = restPose(humanoid);
  const Vec3 hand = position(pose, "leftHand");
  EXPECT_TRUE(
      solve({{KeepOutTask{joint("leftHand"), hand + Vec3(0.05, 0.1, 0.02), hand + Vec3(0.05, 0.1, 0.02), 0.2}}}, pose)
          .met());
  EXPECT_NEAR((position(pose, "leftHand") - (hand + Vec3(0.05, 0.1, 0.02))).norm(), 0.2, 1e-8);
  // A capsule: the distance is from the segment.
  pose = restPose(humanoid);
  const Vec3 a = hand + Vec3(-0.3, 0.05, 0.02), b = hand + Vec3(0.3, 0.05, 0.02);
  EXPECT_TRUE(solve({{KeepOutTask{joint("leftHand"), a, b, 0.15}}}, pose).met());
  const Vec3 away = position(pose, "leftHand") - a;
  EXPECT_NEAR(away.cross((b - a).normalized()).norm(), 0.15, 1e-8);
  // Where it is outside, nothing moves.
  pose = restPose(humanoid);
  const IkTaskResult result =
      solve({{KeepOutTask{joint("leftHand"), hand + Vec3(0, 1, 0), hand + Vec3(0, 1, 0), 0.2}}}, pose);
  EXPECT_EQ(result.iterations, 0u);
  EXPECT_EQ(position(pose, "leftHand"), hand);
}

// A hand that reaches into a sphere that it must keep out of stops on the sphere, nearest to its target.
TEST_F(IkTaskTest, AReachThatLeadsIntoASphereEndsOnIt) {
  options.ik.tolerance = 1e-6;
  const Vec3 center(0.45, 1.3, 0.35), target = center + Vec3(0.05, 0, 0);
  Pose pose = restPose(humanoid);
  const IkTaskResult result = solve(
      {{PositionTask{joint("leftHand"), target}, 1, 1}, {KeepOutTask{joint("leftHand"), center, center, 0.15}, 1, 0}},
      pose);
  EXPECT_TRUE(result.tasks[1].met);
  EXPECT_FALSE(result.tasks[0].met);
  EXPECT_EQ(result.tasks[0].obstacle, IkTaskObstacle::kOtherTasks);
  EXPECT_NEAR((position(pose, "leftHand") - center).norm(), 0.15, 1e-4);
  EXPECT_NEAR(result.tasks[0].residual, 0.1, 2e-3);
}

TEST_F(IkTaskTest, PlanesHoldJointsAboveOrOn) {
  options.ik.tolerance = 1e-9;
  const double height = position(restPose(humanoid), "leftHand").y();
  Pose pose = restPose(humanoid);
  EXPECT_TRUE(solve({{PlaneTask{joint("leftHand"), Vec3::UnitY(), height + 0.1, true}}}, pose).met());
  EXPECT_NEAR(position(pose, "leftHand").y(), height + 0.1, 1e-8);
  pose = restPose(humanoid);
  EXPECT_EQ(solve({{PlaneTask{joint("leftHand"), Vec3::UnitY(), height - 0.1, true}}}, pose).iterations, 0u);
  EXPECT_TRUE(solve({{PlaneTask{joint("leftHand"), Vec3::UnitY(), height - 0.1, false}}}, pose).met());
  EXPECT_NEAR(position(pose, "leftHand").y(), height - 0.1, 1e-8);
}

TEST_F(IkTaskTest, CoupledJointsFollowTheirLeader) {
  Pose pose = restPose(humanoid);
  pose.locals[joint("head")].rotation = fromRotationVector(Vec3(0.1, 0.6, 0)) * pose.locals[joint("head")].rotation;
  const Quat head = pose.locals[joint("head")].rotation;
  EXPECT_TRUE(solve({{CouplingTask{joint("neck"), joint("head"), 0.5}}}, pose).met());
  EXPECT_EQ(pose.locals[joint("head")].rotation.coeffs(), head.coeffs());
  const Quat rest = humanoid.joints[joint("neck")].rest.rotation;
  EXPECT_LT((toRotationVector(rest.conjugate() * pose.locals[joint("neck")].rotation) - Vec3(0.05, 0.3, 0)).norm(),
            1e-9);
  // And with a task that moves the leader.
  pose = restPose(humanoid);
  const IkTaskResult result = solve({{CouplingTask{joint("neck"), joint("head"), 0.5}, 1, 0},
                                     {OrientationTask{joint("head"), fromRotationVector(Vec3(0, 0.9, 0))}, 1, 1}},
                                    pose);
  EXPECT_TRUE(result.met());
  const Vec3 neck = toRotationVector(rest.conjugate() * pose.locals[joint("neck")].rotation);
  const Vec3 turned =
      toRotationVector(humanoid.joints[joint("head")].rest.rotation.conjugate() * pose.locals[joint("head")].rotation);
  EXPECT_LT((neck - 0.5 * turned).norm(), 2e-3);
}

TEST_F(IkTaskTest, BalanceBringsTheMassOverTheFeet) {
  options.ik.rootMotion = RootMotion::kTranslate;
  options.ik.tolerance = 1e-6;
  options.ik.angleTolerance = 1e-6;
  options.masses = {{joint("hips"), Vec3(0, 0, 0.02), 30},
                    {joint("chest"), Vec3(0, 0.1, 0), 20},
                    {joint("leftHand"), Vec3::Zero(), 15}};
  const std::vector<Index> feet = {joint("leftFoot"), joint("rightFoot"), joint("leftToes"), joint("rightToes")};
  std::vector<IkTask> tasks;
  Pose pose = restPose(humanoid);
  for (const char* foot : {"leftFoot", "rightFoot"}) {
    tasks.push_back({PositionTask{joint(foot), position(pose, foot)}});
    tasks.push_back({OrientationTask{joint(foot), rotation(pose, foot)}});
  }
  const auto centerOf = [&](const Pose& p) {
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (const PointMass& mass : options.masses) {
      sum += mass.mass * (poseGlobals(humanoid, p)[mass.joint] * mass.offset);
      total += mass.mass;
    }
    return Vec3(sum / total);
  };
  const double outermost = position(pose, "leftFoot").x();
  ASSERT_GT(centerOf(pose).x(), outermost);  // the heavy hand hangs far out
  tasks.push_back({BalanceTask{feet, false}, 1, 1});
  EXPECT_TRUE(solve(tasks, pose).met());
  // To the edge from foot to toes, and no further.
  const Vec3 foot = position(pose, "leftFoot"), toes = position(pose, "leftToes"), center = centerOf(pose);
  const double along = (center.z() - foot.z()) / (toes.z() - foot.z());
  ASSERT_TRUE(along > 0 && along < 1);
  EXPECT_NEAR(center.x(), foot.x() + along * (toes.x() - foot.x()), 1e-5);
  tasks.back() = {BalanceTask{feet, true}, 1, 1};
  EXPECT_TRUE(solve(tasks, pose).met());
  Vec3 mean = Vec3::Zero();
  for (const Index support : feet) mean += posePositions(humanoid, pose)[support] / 4;
  EXPECT_NEAR(centerOf(pose).x(), mean.x(), 1e-5);
  EXPECT_NEAR(centerOf(pose).z(), mean.z(), 1e-5);
}

// Random tasks of two priorities, most of them too much to ask: what the first gets alone it keeps.
TEST_F(IkTaskTest, LaterPrioritiesTakeNothingFromEarlierOnes) {
  RandomValues random(3);
  const JointLimits limits = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
  options.ik.restarts = 0;
  constexpr const char* kEnds[] = {"leftHand", "rightHand", "head", "leftFoot"};
  int conflicts = 0;
  for (int i = 0; i < 40; ++i) {
    const auto anyTask = [&](int priority) {
      const Index end = joint(kEnds[random.below(4)]);
      const double far = random.uniform(0.2, 1);  // in a statement of its own: the order of operands is the compiler's
      const Vec3 direction = random.direction(), point = Vec3(0, 1.2, 0) + far * direction;
      switch (random.below(5)) {
        case 0:
          return IkTask{LookAtTask{joint("head"), point, Vec3::UnitZ()}, 1, priority};
        case 1:
          return IkTask{PlaneTask{end, direction, random.uniform(0.5, 1.2), true}, 1, priority};
        case 2:
          return IkTask{KeepOutTask{end, point, point, random.uniform(0.1, 0.4)}, 1, priority};
        default:
          return IkTask{PositionTask{end, point}, 1, priority};
      }
    };
    const std::vector<IkTask> first = {anyTask(0), anyTask(0)};
    std::vector<IkTask> both = first;
    both.push_back(anyTask(1));
    both.push_back(anyTask(2));
    const JointLimits* some = i % 2 == 0 ? &limits : nullptr;
    // From the pose that serves the first priority alone: what comes later may take nothing away from it.
    Pose alone = restPose(humanoid);
    const IkTaskResult before = solve(first, alone, some);
    Pose together = alone;
    const IkTaskResult after = solve(both, together, some);
    const auto sumOf = [&](const IkTaskResult& result) {
      double sum = 0;
      for (std::size_t t = 0; t < 2; ++t) {
        const double scale = result.tasks[t].isAngle ? 0.25 * 1.2 : 1;
        sum += std::pow(scale * result.tasks[t].residual, 2);
      }
      return sum;
    };
    // Metres: the tolerance is a ten thousandth of at most 1.6 m.
    EXPECT_LE(std::sqrt(sumOf(after)), std::sqrt(sumOf(before)) + 1e-3) << i;
    for (std::size_t t = 0; t < 2; ++t) EXPECT_TRUE(after.tasks[t].met || !before.met()) << i;
    conflicts += !after.met();
    for (Index j = 0; some && j < humanoid.jointCount(); ++j) {
      EXPECT_LT(limitViolation(limits.joints[j], together.locals[j].rotation), 1e-6);
    }
  }
  EXPECT_GE(conflicts, 5);  // else nothing is shown
}

TEST_F(IkTaskTest, WhatCannotBeMetIsSaid) {
  Pose pose = restPose(humanoid);
  const Vec3 far(4, 1, 0);
  IkTaskResult result = solve({{PositionTask{joint("leftHand"), far}}}, pose);
  EXPECT_FALSE(result.met());
  EXPECT_EQ(result.tasks[0].obstacle, IkTaskObstacle::kTooFar);
  EXPECT_NEAR(result.tasks[0].residual, (position(pose, "leftHand") - far).norm(), 1e-9);
  // Two points for one hand: both are possible alone.
  pose = restPose(humanoid);
  result = solve(
      {{PositionTask{joint("leftHand"), Vec3(0.4, 1.2, 0.3)}}, {PositionTask{joint("leftHand"), Vec3(0.3, 1.4, 0.2)}}},
      pose);
  EXPECT_EQ(result.tasks[0].obstacle, IkTaskObstacle::kOtherTasks);
  EXPECT_EQ(result.tasks[1].obstacle, IkTaskObstacle::kOtherTasks);
  const double apart = (Vec3(0.4, 1.2, 0.3) - Vec3(0.3, 1.4, 0.2)).norm();
  EXPECT_NEAR(result.tasks[0].residual + result.tasks[1].residual, apart, 1e-3);
  // A head that looks behind it, its hips pinned: the neck does not turn so far.
  JointLimits limits;
  limits.joints.resize(humanoid.jointCount());
  for (JointLimit& limit : limits.joints) limit.motion = Hinge{{-0.1, 0.1}};
  for (Index j = 0; j < humanoid.jointCount(); ++j) limits.joints[j].neutral = humanoid.joints[j].rest.rotation;
  pose = restPose(humanoid);
  result = solve({{LookAtTask{joint("head"), Vec3(0, 1.5, -3), Vec3::UnitZ()}}}, pose, &limits);
  EXPECT_TRUE(result.tasks[0].isAngle);
  EXPECT_EQ(result.tasks[0].obstacle, IkTaskObstacle::kLimits);
  EXPECT_GT(result.tasks[0].residual, 1);
}

// Positions asked for as tasks get where whole-body brings targets.
TEST_F(IkTaskTest, PositionsAreWhatTargetsAre) {
  RandomValues random(4);
  for (int i = 0; i < 10; ++i) {
    Pose wanted = restPose(humanoid);
    for (Transform& local : wanted.locals) local.rotation = local.rotation.slerp(0.15, random.rotation());
    wanted.locals[0] = restPose(humanoid).locals[0];
    std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
    std::vector<IkTask> tasks;
    for (IkTarget& target : targets) {
      target.position = posePositions(humanoid, wanted)[target.joint];
      tasks.push_back({PositionTask{target.joint, target.position}});
    }
    Pose byTargets = restPose(humanoid), byTasks = byTargets;
    EXPECT_TRUE(solveIk(findIkMethod("whole-body"), humanoid, byTargets, targets).reached());
    EXPECT_TRUE(solve(tasks, byTasks).met());
  }
}

TEST_F(IkTaskTest, TheSameCallGivesTheSameBitsAndKeepsBones) {
  options.ik.restarts = 1;
  Pose once = restPose(humanoid), again = once;
  const IkTaskResult a = solve(oneOfEach(), once), b = solve(oneOfEach(), again);
  for (Index j = 0; j < humanoid.jointCount(); ++j) {
    EXPECT_EQ(once.locals[j].rotation.coeffs(), again.locals[j].rotation.coeffs());
    EXPECT_EQ(once.locals[j].translation, humanoid.joints[j].rest.translation);
  }
  for (std::size_t t = 0; t < a.tasks.size(); ++t) EXPECT_EQ(a.tasks[t].residual, b.tasks[t].residual);
}

TEST_F(IkTaskTest, BadTasksAreRefusedByNumber) {
  const auto refused = [&](const IkTask& bad) {
    Pose pose = restPose(humanoid);
    try {
      solve({{PositionTask{joint("head"), Vec3::Zero()}}, bad}, pose);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "task 1");
    }
  };
  refused({PositionTask{60, Vec3::Zero()}});
  refused({PositionTask{0, Vec3(NAN, 0, 0)}});
  refused({PositionTask{0, Vec3::Zero()}, 0});
  refused({LookAtTask{0, Vec3::Zero(), Vec3(1, 1, 0)}});
  refused({DistanceTask{0, Index{0}, 1}});
  refused({DistanceTask{0, Index{1}, -1}});
  refused({PlaneTask{0, Vec3::Zero(), 0, true}});
  refused({BalanceTask{}});
  refused({KeepOutTask{0, Vec3::Zero(), Vec3::Zero(), 0}});
  refused({CouplingTask{3, 3, 1}});
  refused({BalanceTask{std::vector<Index>(kMaxSupports + 1, 0)}});
  Pose pose = restPose(humanoid);
  EXPECT_THROW(solve({}, pose), Error);
}

TEST_F(IkTaskTest, MoreTasksThanCanBeAreRefused) {
  Pose pose = restPose(humanoid);
  const IkTask task = {PositionTask{joint("head"), position(pose, "head")}};
  EXPECT_TRUE(solve(std::vector<IkTask>(kMaxIkTasks, task), pose).met());
  try {
    solve(std::vector<IkTask>(kMaxIkTasks + 1, task), pose);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
  }
}

TEST_F(IkTaskTest, AnyNumberOfThreadsGivesTheSameBits) {
  options.ik.restarts = 1;
  std::vector<Pose> poses;
  for (const int threads : {1, 2, 5}) {
    setThreadCount(threads);
    solve(oneOfEach(), poses.emplace_back(restPose(humanoid)));
  }
  setThreadCount(0);
  for (const Pose& pose : poses) {
    for (Index j = 0; j < humanoid.jointCount(); ++j) {
      EXPECT_EQ(pose.locals[j].rotation.coeffs(), poses[0].locals[j].rotation.coeffs());
    }
  }
}

}  // namespace
}  // namespace limber
