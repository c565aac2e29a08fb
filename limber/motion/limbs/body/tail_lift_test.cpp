#include "limber/motion/limbs/body/tail_lift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

class TailLiftTest : public ::testing::Test {
 protected:
  TailLiftTest() : longTailed_(quadruped(0.5)) {
    for (Joint& joint : longTailed_.joints) {
      if (joint.name.starts_with("tail")) joint.rest.translation = Vec3(0, 0, -0.6);
    }
    setup_.emplace(source_, longTailed_, matchSkeletons(source_, longTailed_), RetargetOptions{});
    root_.emplace(*setup_);
    lift_.emplace(*setup_, *root_);
  }

  // With the tail turned by so many degrees about its first joint; down are positive.
  void turnTail(double degrees) {
    pose_ = restPose(longTailed_);
    pose_.locals[joint("tail1")].rotation = limber::testing::turn(Vec3::UnitX(), -degrees);
    setup_->targetKinematics.globals(pose_, frame_);
    lift_->apply(pose_, frame_);
  }
  Index joint(const char* name) const { return longTailed_.find(name).value(); }
  double lowest() const {
    double low = HUGE_VAL;
    for (const char* name : {"tail1", "tail2", "tail3"}) low = std::min(low, frame_.positions[joint(name)].y());
    return low;
  }

  const Skeleton source_ = quadruped(0.5);
  Skeleton longTailed_;
  std::optional<RetargetSetup> setup_;
  std::optional<RootPositioner> root_;
  std::optional<TailLift> lift_;
  Pose pose_;
  BodyFrame frame_;
};

TEST_F(TailLiftTest, TurnsATailUpThatHangsIntoTheGround) {
  ASSERT_EQ(setup_->animalLegs.size(), 4u);
  turnTail(70);  // 1.2 metres of it, and the hips are as high as one
  EXPECT_GT(lowest(), setup_->targetGround);
  EXPECT_LT(lowest(), setup_->targetGround + 0.1);
  EXPECT_LT(frame_.positions[joint("tail3")].z(), -0.3) << "it goes back";
  BodyFrame anew;
  setup_->targetKinematics.globals(pose_, anew);
  EXPECT_LT((anew.positions[joint("tail3")] - frame_.positions[joint("tail3")]).norm(), 1e-9);
}

TEST_F(TailLiftTest, LeavesATailThatIsUp) {
  turnTail(-20);
  const Quat turned = limber::testing::turn(Vec3::UnitX(), 20);
  EXPECT_LT(pose_.locals[joint("tail1")].rotation.angularDistance(turned), 0.002);
}

TEST_F(TailLiftTest, ComesWithoutAJump) {
  turnTail(-60);
  double before = lowest();
  for (double degrees = -60; degrees <= 85; degrees += 0.5) {
    turnTail(degrees);
    EXPECT_LT(std::abs(lowest() - before), 0.03) << degrees;
    before = lowest();
  }
}

}  // namespace
}  // namespace limber
