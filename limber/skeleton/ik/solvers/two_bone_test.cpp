#include "limber/skeleton/ik/solvers/two_bone.h"

#include <random>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

struct Solved {
  Vec3 middle, end;
};

Solved rebuilt(const TwoBone& bones) {
  const TwoBoneTurns turns = solveTwoBone(bones);
  EXPECT_NEAR(turns.start.norm(), 1, 1e-9);
  EXPECT_NEAR(turns.middle.norm(), 1, 1e-9);
  const Vec3 middle = bones.start + turns.start * Vec3(bones.middle - bones.start);
  return {middle, middle + turns.middle * Vec3(bones.end - bones.middle)};
}

class TwoBoneTest : public ::testing::Test {
 protected:
  Vec3 vector(double size) {
    std::uniform_real_distribution<> uniform(-size, size);
    return Vec3(uniform(generator), uniform(generator), uniform(generator));
  }
  std::mt19937_64 generator{3};
};

TEST_F(TwoBoneTest, ReachesBendsToThePoleAndTurnsTheMiddleAboutItsHingeOnly) {
  for (int i = 0; i < 5000; ++i) {
    TwoBone bones{vector(1), vector(1), vector(1), vector(1), {}};
    if (i % 2 == 0) bones.pole = vector(2);
    const double upper = (bones.middle - bones.start).norm(), lower = (bones.end - bones.middle).norm();
    const double distance = (bones.target - bones.start).norm();
    const Solved solved = rebuilt(bones);
    const TwoBonePositions positions = twoBonePositions(bones);
    EXPECT_LT((positions.middle - solved.middle).norm() + (positions.end - solved.end).norm(), 1e-9);
    const double reachable = std::clamp(distance, std::abs(upper - lower), upper + lower);
    EXPECT_NEAR((solved.end - bones.start).norm(), reachable, 1e-9);
    EXPECT_LT((solved.end - bones.start).cross(bones.target - bones.start).norm(), 1e-8) << "towards the target";
    if (reachable == distance) {
      EXPECT_LT((solved.end - bones.target).norm(), 1e-8);
    }

    const Vec3 along = (bones.target - bones.start).normalized();
    const Vec3 bend = solved.middle - bones.start - (solved.middle - bones.start).dot(along) * along;
    if (bones.pole && reachable == distance) {
      const Vec3 pole = *bones.pole - bones.start - (*bones.pole - bones.start).dot(along) * along;
      EXPECT_GT(bend.dot(pole), (1 - 1e-6) * bend.norm() * pole.norm());
    }
    const TwoBoneTurns turns = solveTwoBone(bones);
    const Vec3 normal = (bones.middle - bones.start).cross(bones.end - bones.middle).normalized();
    const Vec3 hinge = toRotationVector(turns.start.conjugate() * turns.middle);
    EXPECT_LT(hinge.cross(normal).norm(), 1e-6) << "in the start's frame the middle turns about the bend's normal";
  }
}

TEST_F(TwoBoneTest, StraightFoldedAndCoincidingAreSolved) {
  const TwoBone straight{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(0, 1, 0), {}, Vec3::UnitX()};
  EXPECT_LT((rebuilt(straight).end - straight.target).norm(), 1e-9);
  EXPECT_NEAR(rebuilt(straight).middle.x(), 0, 1e-12) << "bends about the normal given";
  TwoBone folded{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(1, 0.5, 0), {}, Vec3::UnitZ()};
  EXPECT_LT((rebuilt(folded).end - folded.target).norm(), 1e-9);
  folded.target = folded.start;
  EXPECT_LT((rebuilt(folded).end - folded.target).norm(), 1e-9);
  TwoBone behind = straight;
  behind.target = Vec3(0, -1.5, 0);
  EXPECT_LT((rebuilt(behind).end - behind.target).norm(), 1e-9);
}

TEST_F(TwoBoneTest, NoPoseChangeWhereTheTargetIsMet) {
  for (int i = 0; i < 200; ++i) {
    TwoBone bones{vector(1), vector(1), vector(1), Vec3::Zero(), {}};
    bones.target = bones.end;
    const TwoBoneTurns turns = solveTwoBone(bones);
    EXPECT_LT(angleBetween(turns.start, Quat::Identity()), 1e-6);
    EXPECT_LT(angleBetween(turns.middle, Quat::Identity()), 1e-6);
  }
}

TEST_F(TwoBoneTest, TheMethodRefusesWhatItCannotDo) {
  const Skeleton chain = straightChain(4, 1);
  std::vector<IkTarget> targets(1);
  targets[0].joint = 3;
  EXPECT_THROW(IkSolver(findIkMethod("two-bone"), chain, targets), Error);
  targets[0].base = 1;
  EXPECT_NO_THROW(IkSolver(findIkMethod("two-bone"), chain, targets));
}

TEST_F(TwoBoneTest, SeveralLimbsBendToTheirPoles) {
  const Skeleton humanoid = practiceHumanoid();
  std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
  targets.resize(4);
  for (IkTarget& target : targets) {
    target.base = humanoid.joints[*humanoid.joints[target.joint].parent].parent;
    target.position = 0.8 * target.position + 0.2 * Vec3(0, 1.2, 0.3);
    target.pole = target.position + Vec3(0, 0, 5);
  }
  Pose pose = restPose(humanoid);
  EXPECT_TRUE(solveIk(findIkMethod("two-bone"), humanoid, pose, targets).reached());
  const std::vector<Affine> globals = poseGlobals(humanoid, pose);
  const Vec3 hip = globals[*targets[2].base].translation(), foot = globals[targets[2].joint].translation();
  const Vec3 knee = globals[*humanoid.joints[targets[2].joint].parent].translation();
  EXPECT_GT(knee.z(), 0.5 * (hip + foot).z() + 0.05) << "the knee bends forward";
}

}  // namespace
}  // namespace limber
