#include "limber/motion/limbs/contacts/foot_pitch.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/limbs/limb_goals.h"

namespace limber {
namespace {

using limber::testing::turn;

// By how many degrees limitFootPitch turns the left foot of a person with feet `times` as long, at rest except for
// `hips` and `foot`; `left` is the remaining rotation of the foot against the ground.
struct LimitedFoot {
  double changed = 0, left = 0, fraction = 0;
};
LimitedFoot limited(double times, const Quat& hips, const Quat& foot, double flatness = 0) {
  const Skeleton person = practiceHumanoid();
  Skeleton longFooted = person;
  for (const char* toes : {"leftToes", "rightToes"}) {
    longFooted.joints[longFooted.find(toes).value()].rest.translation *= times;
  }
  const RetargetSetup setup(person, longFooted, matchSkeletons(person, longFooted), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  goals.legs()[0].state.contact.flatness = flatness;
  Pose pose = restPose(longFooted);
  const Index joint = longFooted.find("leftFoot").value();
  pose.locals[longFooted.find("hips").value()].rotation = hips;
  pose.locals[joint].rotation = foot;
  BodyFrame frame, after;
  setup.targetKinematics.globals(pose, frame);
  const Quat before = frame.rotations[joint];
  limitFootPitch(setup, root, goals.legs(), pose, frame);
  setup.targetKinematics.globals(pose, after);
  for (std::size_t j = 0; j < after.positions.size(); ++j) {
    EXPECT_LT((after.positions[j] - frame.positions[j]).norm(), 1e-12) << "the frame is up to date";
  }
  const double degrees = 180 / kPi;
  return {degrees * angleBetween(before, after.rotations[joint]),
          degrees * angleBetween(Quat::Identity(), after.rotations[joint]), goals.legs()[0].spec.footPitch};
}

TEST(FootPitch, OrdinaryFeetPitchAsTheSources) {
  for (const double times : {0.5, 1.0, 1.25}) {
    const LimitedFoot foot = limited(times, Quat::Identity(), turn(Vec3::UnitX(), 40));
    EXPECT_EQ(foot.fraction, 1);
    EXPECT_EQ(foot.changed, 0);
  }
}

TEST(FootPitch, LongOnesPitchLess) {
  const LimitedFoot foot = limited(4, Quat::Identity(), turn(Vec3::UnitX(), 40));
  EXPECT_LT(foot.fraction, 0.5);
  EXPECT_NEAR(foot.left, 40 * foot.fraction, 2);
}

TEST(FootPitch, OnesThatStandFlatLieAsAtRest) {
  const Quat tipped = turn(Vec3::UnitX(), 2);
  EXPECT_LT(limited(1, Quat::Identity(), tipped, 1).left, 0.3);
  EXPECT_EQ(limited(1, Quat::Identity(), tipped, 0).changed, 0);
  EXPECT_LT(limited(1, Quat::Identity(), turn(Vec3::UnitX(), 45), 1).changed, 1) << "the heel is up";
}

TEST(FootPitch, TheyFaceWhereTheyFace) {
  EXPECT_LT(limited(4, Quat::Identity(), turn(Vec3::UnitY(), 50)).changed, 1e-5);
  EXPECT_LT(limited(1, Quat::Identity(), turn(Vec3::UnitY(), 50), 1).changed, 1e-5);
}

TEST(FootPitch, SolesThatLookUpOrToTheSideStay) {
  EXPECT_LT(limited(4, Quat::Identity(), turn(Vec3::UnitX(), 130)).changed, 1e-5);
  EXPECT_LT(limited(4, turn(Vec3::UnitZ(), 90), turn(Vec3::UnitX(), 20)).changed, 1);
}

// What keepTipUp does to the left foot of someone who is lifted and whose foot is turned like that.
struct Tip {
  double over = 0, turned = 0;  // metres over the ground, degrees
};
Tip keptUp(double lift, double degrees) {
  const Skeleton toeless = limber::testing::withoutToes(practiceHumanoid()), person = practiceHumanoid();
  const RetargetSetup setup(toeless, person, matchSkeletons(toeless, person), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  const Leg& leg = goals.legs()[0];
  Pose pose = restPose(person);
  pose.locals[person.find("hips").value()].translation.y() += lift;
  pose.locals[leg.spec.end].rotation = turn(Vec3::UnitX(), degrees);
  BodyFrame frame;
  setup.targetKinematics.globals(pose, frame);
  const Quat before = frame.rotations[leg.spec.end];
  keepTipUp(setup, root, leg.spec, pose, frame);
  const double turned = angleBetween(before, frame.rotations[leg.spec.end]) * 180 / kPi;
  return {frame.positions[leg.spec.tip.value()].y() - leg.spec.toesGround, turned};
}

TEST(FootPitch, ATipThatTheSourceLacksStaysAboveTheGround) {
  for (const double degrees : {10.0, 40.0, 80.0, 110.0}) {
    EXPECT_GT(keptUp(0.03, degrees).over, -1e-9) << degrees;
  }
  EXPECT_LT(keptUp(0.03, 80).over, 0.01) << "no further up than that";
  EXPECT_LT(keptUp(0.5, 40).turned, 0.1);
  EXPECT_LT(keptUp(0.02, 180).turned, 0.1) << "soles that look up stay";
  // It lets go of the ground without a snap.
  double before = keptUp(0, 110).turned;
  for (double lift = 0.002; lift < 0.5; lift += 0.002) {
    const double now = keptUp(lift, 110).turned;
    EXPECT_LT(std::abs(now - before), 4) << lift;
    before = now;
  }
}

}  // namespace
}  // namespace limber
