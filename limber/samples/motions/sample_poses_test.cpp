#include "limber/samples/motions/sample_poses.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

double lowestJoint(const PortablePose& pose) {
  double lowest = 1;
  for (const Vec3& position : posePositions(pose.skeleton, pose.pose)) lowest = std::min(lowest, position.y());
  return lowest;
}

double heightOf(const PortablePose& pose, const char* joint) {
  return posePositions(pose.skeleton, pose.pose)[pose.skeleton.find(joint).value()].y();
}

TEST(SamplePoses, ArePosesOfTheirSkeletons) {
  EXPECT_GE(samplePoses().size(), 12u);
  for (const SamplePose& sample : samplePoses()) {
    SCOPED_TRACE(sample.name);
    const PortablePose pose = makeSamplePose(sample.name);
    checkSkeleton(pose.skeleton);
    ASSERT_EQ(pose.pose.locals.size(), pose.skeleton.joints.size());
    for (const Transform& local : pose.pose.locals) {
      EXPECT_NEAR(local.rotation.norm(), 1, 1e-12);
      EXPECT_TRUE(local.translation.allFinite());
    }
  }
  EXPECT_THROW(makeSamplePose("fly"), Error);
}

TEST(SamplePoses, StandOnTheGroundButForTheJump) {
  constexpr double kNearGround = 0.06;  // metres, of the lowest joint of a body that is on it
  for (const SamplePose& sample : samplePoses()) {
    const double lowest = lowestJoint(makeSamplePose(sample.name));
    EXPECT_GT(lowest, -0.005) << sample.name;
    if (sample.name == "jump") {
      EXPECT_GT(lowest, 0.15);
    } else {
      EXPECT_LT(lowest, kNearGround) << sample.name;
    }
  }
}

TEST(SamplePoses, AreWhatTheyAreCalled) {
  const PortablePose stand = makeSamplePose("stand"), sit = makeSamplePose("sit"), crouch = makeSamplePose("crouch"),
                     kneel = makeSamplePose("kneel"), wave = makeSamplePose("wave"), cheer = makeSamplePose("cheer");
  EXPECT_LT(heightOf(sit, "hips"), 0.65 * heightOf(stand, "hips"));
  EXPECT_LT(heightOf(crouch, "hips"), heightOf(sit, "hips"));
  EXPECT_LT(heightOf(kneel, "rightLowerLeg"), 0.10);
  EXPECT_GT(heightOf(kneel, "leftLowerLeg"), 0.40);
  EXPECT_GT(heightOf(wave, "rightHand"), heightOf(wave, "neck"));
  EXPECT_LT(heightOf(wave, "leftHand"), heightOf(wave, "hips"));
  EXPECT_GT(std::min(heightOf(cheer, "leftHand"), heightOf(cheer, "rightHand")), heightOf(cheer, "head"));
  const PortablePose fox = makeSamplePose("animal-stand"), sits = makeSamplePose("animal-sit"),
                     lies = makeSamplePose("animal-lie");
  EXPECT_LT(heightOf(sits, "hips"), 0.5 * heightOf(fox, "hips"));
  EXPECT_GT(heightOf(sits, "head"), heightOf(fox, "head") - 0.1);
  EXPECT_LT(heightOf(lies, "chest"), 0.5 * heightOf(fox, "chest"));
}

}  // namespace
}  // namespace limber
