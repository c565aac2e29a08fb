// The judge against motions that were spoilt by known amounts.
#include "limber/evaluate/motion/retarget_judge.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/limbs/roughness.h"

namespace limber {
namespace {

using namespace testing;

class RetargetJudge : public ::testing::Test {
 protected:
  RetargetVerdict judged(const PoseSequence& result) const { return judgeRetargeting(setup, source, source, result); }

  const Skeleton person = practiceHumanoid();
  const PoseSequence source = walk(person, 240);
  const RetargetSetup setup{person, person, matchSkeletons(person, person), {}, &source};
};

TEST_F(RetargetJudge, TheSameMotionIsFaultless) {
  const RetargetVerdict verdict = judged(source);
  EXPECT_DOUBLE_EQ(verdict.jerk, 1);
  EXPECT_DOUBLE_EQ(verdict.jerkPeak, 1);
  EXPECT_DOUBLE_EQ(verdict.impact, 1);
  EXPECT_DOUBLE_EQ(verdict.bones95, 0);
  EXPECT_DOUBLE_EQ(verdict.sliding, verdict.sourceSliding);
  EXPECT_GT(verdict.contacts.meant, 100);
  EXPECT_EQ(verdict.contacts.precision(), 1);
  EXPECT_EQ(verdict.contacts.recall(), 1);
}

TEST_F(RetargetJudge, SlidingIsSeenAtItsSpeed) {
  PoseSequence result = source;
  const double speed = 0.05;  // metres a second
  for (std::size_t f = 0; f < result.poses.size(); ++f) {
    result.poses[f].locals[0].translation.x() += speed * static_cast<double>(f) * source.frameSeconds;
  }
  const RetargetVerdict verdict = judged(result);
  const double height = standingHeight(setup, MapSide::kTarget);
  EXPECT_NEAR(verdict.sliding - verdict.sourceSliding, speed / height, 0.1 * speed / height);
  EXPECT_NEAR(verdict.jerk, 1, 1e-6) << "an even drift is smooth";
}

TEST_F(RetargetJudge, OneJoltIsAPeak) {
  PoseSequence result = source;
  result.poses[120].locals[0].translation.y() += 0.02;
  const RetargetVerdict verdict = judged(result);
  EXPECT_GT(verdict.jerkPeak, 2);
  EXPECT_GT(verdict.jerkPeak, verdict.jerk);
}

TEST_F(RetargetJudge, ABoneThatIsTurnedIsSeen) {
  PoseSequence result = source;
  for (Pose& pose : result.poses) {
    for (const char* arm : {"leftUpperArm", "rightUpperArm"}) {
      Quat& rotation = pose.locals[person.find(arm).value()].rotation;
      rotation = rotation * turn(Vec3::UnitZ(), 10) * turn(Vec3::UnitY(), 10);
    }
  }
  const RetargetVerdict verdict = judged(result);
  EXPECT_GT(verdict.bones95, 5);
  EXPECT_LT(verdict.bones95, 15);
}

TEST_F(RetargetJudge, FeetThatHoverKeepNoContact) {
  PoseSequence result = source;
  for (Pose& pose : result.poses) pose.locals[0].translation.y() += 0.15;
  EXPECT_EQ(judged(result).contacts.recall(), 0);
}

}  // namespace
}  // namespace limber
