#include "limber/motion/mix/ground_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

TEST(GroundFrame, AStepLeadsFromOneToTheOther) {
  const GroundFrame from{1, -2, 0.4}, to{2.5, 1, 2.9};
  const GroundFrame there = moved(from, stepBetween(from, to));
  EXPECT_NEAR(there.x, to.x, 1e-12);
  EXPECT_NEAR(there.z, to.z, 1e-12);
  EXPECT_NEAR(there.heading, to.heading, 1e-12);
}

// Halfway between straight on and a quarter of a circle is an eighth of one of twice the radius, as long as both.
TEST(GroundFrame, MixedStepsAreMixedArcs) {
  const double length = 3, quarter = kPi / 2;
  const GroundStep straight{0, length, 0}, curve{0, length, quarter};
  const GroundFrame end = moved({}, mixOf(straight, curve, 0.5));
  const double radius = length / (quarter / 2);
  EXPECT_NEAR(end.heading, kPi / 4, 1e-12);
  EXPECT_NEAR(end.x, radius * (1 - std::cos(kPi / 4)), 1e-12);
  EXPECT_NEAR(end.z, radius * std::sin(kPi / 4), 1e-12);
}

TEST(GroundFrame, BetweenTwoHeadingsIsTheShortWay) {
  EXPECT_NEAR(std::cos(between({0, 0, 3}, {0, 0, -3}, 0.5).heading), -1, 1e-12);
}

// Wherever a body is moved and turned to, its frame goes along, and in it the pose is the same.
TEST(GroundFrame, APoseIsTheSameInItsFrame) {
  const Skeleton person = practiceHumanoid();
  const MixBody body(person);
  Pose pose = restPose(person);
  pose.locals[person.find("spine").value()].rotation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  BodyFrame frame;
  body.globals(pose, frame);
  const GroundFrame before = groundFrameOf(body, frame), groundFrame{3, -1, 2.2};
  Pose elsewhere = pose;
  enterFrame(body, before, elsewhere);
  const Pose inFrame = elsewhere;
  leaveFrame(body, groundFrame, elsewhere);
  body.globals(elsewhere, frame);
  const GroundFrame there = groundFrameOf(body, frame);
  EXPECT_NEAR(there.x, groundFrame.x, 1e-9);
  EXPECT_NEAR(there.z, groundFrame.z, 1e-9);
  EXPECT_NEAR(there.heading, groundFrame.heading, 1e-9);
  enterFrame(body, there, elsewhere);
  for (std::size_t j = 0; j < pose.locals.size(); ++j) {
    EXPECT_LT((elsewhere.locals[j].translation - inFrame.locals[j].translation).norm(), 1e-9);
    EXPECT_GT(std::abs(elsewhere.locals[j].rotation.dot(inFrame.locals[j].rotation)), 1 - 1e-12);
  }
}

}  // namespace
}  // namespace limber
