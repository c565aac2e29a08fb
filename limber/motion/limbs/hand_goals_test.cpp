#include "limber/motion/limbs/hand_goals.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::turn;

// Short arms on a body whose head is as far off as the source's.
Skeleton withShortArms() {
  Skeleton person = practiceHumanoid();
  for (Joint& joint : person.joints) {
    if (joint.name.find("LowerArm") != std::string::npos || joint.name.find("Hand") != std::string::npos) {
      joint.rest.translation *= 0.35;
    }
  }
  return person;
}

class HandGoalsTest : public ::testing::Test {
 protected:
  // The left hand goes to the head and past it; the same angles in both.
  template <typename Check>
  void eachFrame(const Skeleton& person, const Check& check) {
    const RetargetSetup setup(source, person, matchSkeletons(source, person), {});
    const RootPositioner root(setup);
    HandGoals hands(setup, root);
    BodyFrame from, to;
    for (int f = 0; f < 120; ++f) {
      Pose pose = restPose(source);
      pose.locals[source.find("leftUpperArm").value()].rotation = turn(Vec3::UnitZ(), 30 + 0.3 * f);
      pose.locals[source.find("leftLowerArm").value()].rotation = turn(Vec3::UnitZ(), 1.2 * f);
      setup.sourceKinematics.globals(pose, from);
      Pose other = restPose(person);
      for (std::size_t j = 0; j < other.locals.size(); ++j) other.locals[j].rotation = pose.locals[j].rotation;
      setup.targetKinematics.globals(other, to);
      hands.set(from, to, f == 0 ? 0 : 1.0 / 60);
      check(hands.arms().front(), to);
    }
  }

  const Skeleton source = practiceHumanoid();
};

TEST_F(HandGoalsTest, TouchesTakeHandsAtMostHalfAnArmFromTheirAngles) {
  double most = 0;
  eachFrame(withShortArms(), [&](const Arm& arm, const BodyFrame& frame) {
    most = std::max(most, (arm.goal.position - frame.positions[arm.spec.end]).norm() / arm.spec.length);
  });
  EXPECT_LT(most, 0.52) << "a spring may swing over a little";
  EXPECT_GT(most, 0.3) << "the head is far off";
}

TEST_F(HandGoalsTest, HandsStayAwayFromTheirShoulders) {
  eachFrame(withShortArms(), [&](const Arm& arm, const BodyFrame& frame) {
    const Vec3 shoulder = frame.positions[arm.spec.upper];
    const double own = (frame.positions[arm.spec.end] - shoulder).norm();
    EXPECT_GE((arm.goal.position - shoulder).norm(), 0.59 * std::min(own, 0.45 * arm.spec.length));
    EXPECT_LE((arm.goal.position - shoulder).norm(), std::max(own, arm.spec.length));
  });
}

TEST_F(HandGoalsTest, EqualBodiesTouchAsTheyDo) {
  eachFrame(source, [&](const Arm& arm, const BodyFrame& frame) {
    EXPECT_LT((arm.goal.position - frame.positions[arm.spec.end]).norm(), 1e-9);
  });
}

}  // namespace
}  // namespace limber
