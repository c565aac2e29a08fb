// What every method must do, on thousands of random skeletons and targets.
#include "limber/skeleton/ik/ik_solver.h"

#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

JointLimit randomLimit(RandomValues& random) {
  JointLimit limit;
  limit.neutral = random.rotation();
  limit.axes = random.rotation();
  const auto range = [&] { return AngleRange{-random.uniform(0.1, 1.3), random.uniform(0.1, 1.3)}; };
  switch (random.below(7)) {
    case 0:
      limit.motion = FreeJoint{};
      break;
    case 1:
      limit.motion = Hinge{range()};
      break;
    case 2:
      limit.motion = BallAndSocket{range(), range(), range()};
      break;
    case 3:
      limit.motion = Condyloid{range(), range()};
      break;
    case 4:
      limit.motion = Saddle{range(), range()};
      break;
    case 5:
      limit.motion = SwingTwist{range(), range(), range()};
      break;
    default: {
      ReachCone cone;
      for (int i = 0; i < 5; ++i) {
        const double angle = 2 * kPi * i / 5, out = random.uniform(0.3, 2);
        cone.polygon.push_back(Vec3(out * std::cos(angle), 1, -out * std::sin(angle)));
      }
      cone.twist = range();
      limit.motion = cone;
    }
  }
  if (random.below(4) == 0) limit.stiffness = random.uniform(0, 0.9);
  return limit;
}

Pose randomPose(const Skeleton& skeleton, const JointLimits* limits, RandomValues& random) {
  Pose pose = restPose(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Quat turn = random.rotation();
    pose.locals[j].rotation = limits ? allowedRotation(limits->joints[j], random.unitCube()) : turn;
  }
  return pose;
}

struct Problem {
  Skeleton skeleton;
  JointLimits limits;
  Pose start;
  std::vector<IkTarget> targets;
};

// A chain or a tree, with scales here and there; targets where another random pose has them.
Problem randomProblem(RandomValues& random, Index joints, bool tree, bool limited) {
  Problem problem;
  for (Index j = 0; j < joints; ++j) {
    Joint& joint = problem.skeleton.joints.emplace_back();
    joint.name.assign(1, static_cast<char>('A' + j));
    if (j > 0) joint.parent = tree && random.below(3) == 0 ? random.below(j) : j - 1;
    joint.rest.translation = random.uniform(0.1, 0.5) * random.direction();
    joint.rest.rotation = random.rotation();
    if (random.below(4) == 0) joint.rest.scale = Vec3::Constant(random.uniform(0.5, 2));
    problem.limits.joints.push_back(limited ? randomLimit(random) : JointLimit{});
  }
  const JointLimits* limits = limited ? &problem.limits : nullptr;
  problem.start = randomPose(problem.skeleton, limits, random);
  const Pose goal = randomPose(problem.skeleton, limits, random);
  const std::vector<Affine> globals = poseGlobals(problem.skeleton, goal);
  std::vector<bool> inner(joints, false);
  for (const Joint& joint : problem.skeleton.joints) {
    if (joint.parent) inner[*joint.parent] = true;
  }
  for (Index j = 1; j < joints; ++j) {
    if (inner[j] && !(tree && random.below(10) == 0)) continue;
    IkTarget target;
    target.joint = j;
    target.position = globals[j].translation();
    target.weight = tree ? random.uniform(0.5, 2) : 1;
    problem.targets.push_back(target);
  }
  return problem;
}

// Global positions by matrices: an oracle apart from the solver's own forward kinematics.
double weightedCost(const Problem& problem, const Pose& pose) {
  const std::vector<Vec3> positions = posePositions(problem.skeleton, pose);
  double sum = 0;
  for (const IkTarget& t : problem.targets) sum += t.weight * (positions[t.joint] - t.position).squaredNorm();
  return sum;
}

class EveryMethod : public ::testing::TestWithParam<std::string> {
 protected:
  const IkMethod& method() const { return findIkMethod(GetParam()); }
  bool isTwoBone() const { return GetParam() == "two-bone"; }
  Index chainJoints(RandomValues& random) const { return isTwoBone() ? 3 : 2 + random.below(9); }
};

void expectBonesKept(const Problem& problem, const Pose& pose) {
  const std::vector<Vec3> before = posePositions(problem.skeleton, problem.start);
  const std::vector<Vec3> after = posePositions(problem.skeleton, pose);
  for (Index j = 1; j < problem.skeleton.jointCount(); ++j) {
    const Index p = *problem.skeleton.joints[j].parent;
    EXPECT_NEAR((after[j] - after[p]).norm(), (before[j] - before[p]).norm(), 1e-12);
    EXPECT_EQ(pose.locals[j].translation, problem.start.locals[j].translation);
    EXPECT_EQ(pose.locals[j].scale, problem.start.locals[j].scale);
    EXPECT_NEAR(pose.locals[j].rotation.norm(), 1, 1e-12);
  }
}

TEST_P(EveryMethod, BonesKeepTheirLengthAndNothingGetsWorse) {
  RandomValues random(11);
  for (int i = 0; i < 300; ++i) {
    const bool tree = i % 3 == 0 && !isTwoBone();
    Problem problem = randomProblem(random, tree ? 8 : chainJoints(random), tree, false);
    if (i % 5 == 0) problem.targets[0].position *= 5;  // mostly out of reach
    Pose pose = problem.start;
    IkOptions options;
    options.restarts = 1;
    const IkResult result = solveIk(method(), problem.skeleton, pose, problem.targets, nullptr, options);
    expectBonesKept(problem, pose);
    EXPECT_LE(weightedCost(problem, pose), weightedCost(problem, problem.start) * (1 + 1e-9) + 1e-12);
    const std::vector<Vec3> positions = posePositions(problem.skeleton, pose);
    for (std::size_t t = 0; t < problem.targets.size(); ++t) {
      const IkTarget& target = problem.targets[t];
      EXPECT_NEAR(result.targets[t].distance, (positions[target.joint] - target.position).norm(), 1e-9);
    }
  }
}

TEST_P(EveryMethod, LimitsHold) {
  RandomValues random(12);
  for (int i = 0; i < 200; ++i) {
    const bool tree = i % 3 == 0 && !isTwoBone();
    const Problem problem = randomProblem(random, tree ? 7 : chainJoints(random), tree, true);
    Pose pose = problem.start;
    IkOptions options;
    options.restarts = 1;
    options.maxIterations = 30;
    solveIk(method(), problem.skeleton, pose, problem.targets, &problem.limits, options);
    expectBonesKept(problem, pose);
    EXPECT_LE(weightedCost(problem, pose), weightedCost(problem, problem.start) * (1 + 1e-9) + 1e-12);
    for (Index j = 0; j < problem.skeleton.jointCount(); ++j) {
      const JointLimit& limit = problem.limits.joints[j];
      EXPECT_LT(limitViolation(limit, pose.locals[j].rotation), 1e-6) << "motion " << limit.motion.index();
    }
  }
}

// All of them; of the methods that creep where a chain is nearly straight, 99 %.
TEST_P(EveryMethod, ReachableTargetsAreReached) {
  RandomValues random(13);
  int solved = 0, count = 2000;
  for (int i = 0; i < count; ++i) {
    const Problem problem = randomProblem(random, isTwoBone() ? 3 : 3 + random.below(9), false, false);
    Pose pose = problem.start;
    IkOptions options;
    options.tolerance = 1e-3;
    const IkResult result = solveIk(method(), problem.skeleton, pose, problem.targets, nullptr, options);
    solved += result.reached();
    for (const IkTargetResult& target : result.targets) EXPECT_NE(target.outcome, IkOutcome::kOutOfReach);
  }
  const bool creeps = GetParam() == "jacobian-transpose" || GetParam() == "ccd" || GetParam() == "ccd-forward";
  EXPECT_GE(solved, creeps ? count * 99 / 100 : count);
}

TEST_P(EveryMethod, TargetsOutOfReachAreNamedAndApproached) {
  RandomValues random(14);
  for (int i = 0; i < 300; ++i) {
    const Skeleton skeleton = straightChain(isTwoBone() ? 3 : 6, 1);
    Pose pose = randomPose(skeleton, nullptr, random);
    pose.locals[0].translation = Vec3(1, 2, 3);
    std::vector<IkTarget> targets(1);
    targets[0].joint = skeleton.jointCount() - 1;
    const double away = random.uniform(1.1, 3);  // drawn first, whichever the compiler would evaluate first
    targets[0].position = Vec3(1, 2, 3) + away * random.direction();
    IkOptions options;
    options.maxIterations = 2000;
    const IkResult result = solveIk(method(), skeleton, pose, targets, nullptr, options);
    EXPECT_EQ(result.targets[0].outcome, IkOutcome::kOutOfReach);
    EXPECT_EQ(result.restarts, 0u);
    const double least = (targets[0].position - Vec3(1, 2, 3)).norm() - 1;
    EXPECT_LE(result.targets[0].distance, least + 0.02);  // the chain stretches towards the target
  }
}

TEST_P(EveryMethod, TheSameCallGivesTheSameBits) {
  RandomValues random(15);
  for (int i = 0; i < 20; ++i) {
    const Problem problem = randomProblem(random, isTwoBone() ? 3 : 8, i % 2 == 0 && !isTwoBone(), i % 4 == 0);
    const JointLimits* limits = i % 4 == 0 ? &problem.limits : nullptr;
    Pose once = problem.start, again = problem.start, warm = problem.start;
    IkSolver solver(method(), problem.skeleton, problem.targets, limits);
    solver.solve(once, problem.targets);
    solver.solve(warm, problem.targets);
    solveIk(method(), problem.skeleton, again, problem.targets, limits);
    for (Index j = 0; j < problem.skeleton.jointCount(); ++j) {
      EXPECT_EQ(once.locals[j].rotation.coeffs(), again.locals[j].rotation.coeffs());
      EXPECT_EQ(once.locals[j].rotation.coeffs(), warm.locals[j].rotation.coeffs());
    }
  }
}

TEST_P(EveryMethod, AnAnswerIsItsOwnAnswer) {
  RandomValues random(16);
  for (int i = 0; i < 20; ++i) {
    const Problem problem = randomProblem(random, isTwoBone() ? 3 : 7, false, false);
    Pose pose = problem.start;
    IkSolver solver(method(), problem.skeleton, problem.targets);
    ASSERT_TRUE(solver.solve(pose, problem.targets).reached());
    const Pose first = pose;
    EXPECT_EQ(solver.solve(pose, problem.targets).iterations, 0u);
    for (Index j = 0; j < problem.skeleton.jointCount(); ++j) {
      EXPECT_LT(angleBetween(pose.locals[j].rotation, first.locals[j].rotation), 1e-12);
    }
  }
}

TEST_P(EveryMethod, OrientationsAreMet) {
  RandomValues random(17);
  for (int i = 0; i < 300; ++i) {
    Problem problem = randomProblem(random, isTwoBone() ? 3 : 6, false, false);
    const Quat wanted = random.rotation();
    problem.targets[0].orientation = wanted;
    Pose pose = problem.start;
    const IkResult result = solveIk(method(), problem.skeleton, pose, problem.targets);
    EXPECT_TRUE(result.reached()) << result.targets[0].distance << " " << result.targets[0].angle;
    Quat global = Quat::Identity();
    for (const Transform& local : pose.locals) global = global * local.rotation;
    EXPECT_LT(angleBetween(global, wanted), 1.1e-3);
  }
}

// The mirror image of a problem has the mirror image of its answer.
TEST_P(EveryMethod, MirroredProblemsHaveMirroredAnswers) {
  RandomValues random(18);
  const auto mirror = [](const Quat& q) { return Quat(q.w(), q.x(), -q.y(), -q.z()); };
  const Vec3 flip(-1, 1, 1);
  for (int i = 0; i < 200; ++i) {
    const Problem problem = randomProblem(random, isTwoBone() ? 3 : 6, i % 2 == 0 && !isTwoBone(), false);
    Problem mirrored = problem;
    for (Index j = 0; j < problem.skeleton.jointCount(); ++j) {
      Transform& local = mirrored.start.locals[j];
      local.translation = local.translation.cwiseProduct(flip);
      local.rotation = mirror(local.rotation);
    }
    for (IkTarget& target : mirrored.targets) target.position = target.position.cwiseProduct(flip);
    IkOptions options;
    options.restarts = 0;
    options.maxIterations = 5;
    Pose pose = problem.start, image = mirrored.start;
    solveIk(method(), problem.skeleton, pose, problem.targets, nullptr, options);
    solveIk(method(), mirrored.skeleton, image, mirrored.targets, nullptr, options);
    for (Index j = 0; j < problem.skeleton.jointCount(); ++j) {
      EXPECT_LT(angleBetween(mirror(pose.locals[j].rotation), image.locals[j].rotation), 1e-6);
    }
  }
}

// Along a smooth path of 1,000 targets no joint turns further in one step than a few times what the step asks for.
TEST_P(EveryMethod, DraggingDoesNotFlip) {
  const Index joints = isTwoBone() ? 3 : 8;
  const Skeleton skeleton = straightChain(joints, 1);
  Pose pose = restPose(skeleton);
  for (Index j = 0; j < joints; ++j) pose.locals[j].rotation = fromRotationVector(Vec3(0.3, 0.05, 0.2));
  std::vector<IkTarget> targets(1);
  targets[0].joint = joints - 1;
  IkOptions options;
  options.restarts = 0;
  IkSolver solver(method(), skeleton, targets, nullptr, options);
  const auto path = [](double u) {  // a closed curve within reach, 0.25 to 0.9 from the base
    const double a = 2 * kPi * u;
    return Vec3(0.35 * std::sin(a) + 0.2, 0.55 + 0.2 * std::cos(2 * a), 0.3 * std::cos(a));
  };
  targets[0].position = path(0);
  ASSERT_TRUE(solver.solve(pose, targets).reached());
  double largest = 0;
  for (int step = 1; step <= 1000; ++step) {
    const Pose before = pose;
    targets[0].position = path(step / 1000.0);
    EXPECT_TRUE(solver.solve(pose, targets).reached()) << step;
    for (Index j = 0; j < joints; ++j) {
      largest = std::max(largest, angleBetween(before.locals[j].rotation, pose.locals[j].rotation));
    }
  }
  // The targets are up to 3 mm apart; 0.03 rad would move a tip half a metre away by 15 mm.
  EXPECT_LT(largest, 0.03);
}

TEST_P(EveryMethod, BadCallsAreRefused) {
  const Skeleton skeleton = straightChain(3, 1);
  std::vector<IkTarget> good(1);
  good[0].joint = 2;
  IkSolver solver(method(), skeleton, good);
  Pose pose = restPose(skeleton);
  const auto refused = [&](const std::vector<IkTarget>& targets) {
    EXPECT_THROW(solver.solve(pose, targets), Error);
    EXPECT_THROW(IkSolver(method(), skeleton, targets).solve(pose, targets), Error);
  };
  refused({});
  std::vector<IkTarget> bad = good;
  bad[0].joint = 3;
  refused(bad);
  bad = good;
  bad[0].position.x() = NAN;
  refused(bad);
  bad = good;
  bad[0].weight = 0;
  refused(bad);
  bad = good;
  bad[0].joint = 1;
  bad[0].base = 2;
  refused(bad);
  pose.locals.pop_back();
  EXPECT_THROW(solver.solve(pose, good), Error);
  Pose squashed = restPose(skeleton);
  squashed.locals[1].scale = Vec3(1, 2, 1);
  EXPECT_THROW(solver.solve(squashed, good), Error);
}

INSTANTIATE_TEST_SUITE_P(Ik, EveryMethod, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const IkMethod& method : ikMethods()) names.emplace_back(method.name);
                           return names;
                         }()),
                         [](const ::testing::TestParamInfo<std::string>& which) {
                           std::string name = which.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(IkMethods, UnknownNamesAreRefusedWithTheNamesThereAre) {
  try {
    findIkMethod("magic");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.remedy().find("fabrik"), std::string::npos);
  }
}

TEST(IkSkeletons, TheHumanoidHasSixtyJoints) {
  const Skeleton humanoid = practiceHumanoid();
  checkSkeleton(humanoid);
  EXPECT_EQ(humanoid.jointCount(), 60u);
  EXPECT_EQ(practiceHumanoidTargets(humanoid).size(), 5u);
}

}  // namespace
}  // namespace limber
