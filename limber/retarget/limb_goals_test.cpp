#include "limber/retarget/limb_goals.h"

#include <gtest/gtest.h>

#include "limber/retarget/testing/test_motion.h"

namespace limber {
namespace {

// How far above its place by the joint angles the left foot is held, of someone who comes down to the ground at
// `speed`, metres a second, when it is there.
double heldUp(double speed) {
  const Skeleton person = practiceHumanoid(), odd = limber::testing::oddlyBuilt();
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {});
  const RootPlacer root(setup);
  LimbGoals goals(setup, root);
  const Leg& leg = goals.legs().front();
  constexpr double kFrame = 1.0 / 60;
  double up = 0;
  for (int left = 10; left >= 0; --left) {
    const Vec3 height(0, left * kFrame * speed, 0);
    Pose from = restPose(person), to = restPose(odd);
    from.locals[0].translation += height;
    to.locals[0].translation += height;
    BodyFrame source, target;
    setup.sourceKinematics.globals(from, source);
    setup.targetKinematics.globals(to, target);
    const double seconds = left == 10 ? 0 : kFrame;
    goals.calm(source, seconds, to, target);
    goals.setFeet(source, target, seconds);
    up = leg.goal.y() - target.positions[leg.end].y();
  }
  return up;
}

TEST(LimbGoals, AFootSlowsDownTheEarlierTheFasterItComes) {
  EXPECT_LT(heldUp(0.1), 0.01);
  EXPECT_GT(heldUp(2), heldUp(0.1) + 0.01);
  EXPECT_LT(heldUp(20), 0.05) << "however fast";
}

}  // namespace
}  // namespace limber
