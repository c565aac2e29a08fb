#include "limber/skeleton/keyframes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

Skeleton keyedArm() {
  Skeleton skeleton;
  for (const char* name : {"shoulder", "elbow", "hand"}) {
    Joint joint;
    joint.name = name;
    if (!skeleton.joints.empty()) joint.parent = skeleton.jointCount() - 1;
    joint.rest.translation = Vec3(0.3, 0, 0);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

Pose elbowBent(double degrees, Index joint = 1) {
  Pose pose = restPose(keyedArm());
  pose.locals[joint].rotation = Quat(Eigen::AngleAxisd(degrees * EIGEN_PI / 180, Vec3::UnitZ()));
  return pose;
}

double elbowAt(const Clip& clip, double seconds) {
  Pose pose = restPose(keyedArm());
  sampleClip(clip, seconds, pose);
  const Quat& q = pose.locals[1].rotation;
  return 2 * std::atan2(q.z(), q.w()) * 180 / EIGEN_PI;
}

Clip waving() {
  Clip clip;
  clip.name = "waving";
  setKey(clip, keyedArm(), elbowBent(0), 0);
  setKey(clip, keyedArm(), elbowBent(60), 1);
  setKey(clip, keyedArm(), elbowBent(20), 2);
  return clip;
}

TEST(Keyframes, PosesComeBackAtTheirKeysAndBetweenThem) {
  const Clip clip = waving();
  checkClip(clip, keyedArm());
  EXPECT_THAT(keyTimes(clip), ElementsAre(0, 1, 2));
  EXPECT_NEAR(elbowAt(clip, 0.5), 30, 1e-3);
  EXPECT_NEAR(elbowAt(clip, 1), 60, 1e-3);
  EXPECT_NEAR(elbowAt(clip, 1.5), 40, 1e-3);
  EXPECT_EQ(clip.rotations.size(), 2u);  // the root's and the elbow's
  EXPECT_TRUE(clip.translations.empty() && clip.scales.empty());
}

TEST(Keyframes, AJointThatMovesLaterRestsAtTheEarlierKeys) {
  Clip clip;
  setKey(clip, keyedArm(), elbowBent(30), 0);
  setKey(clip, keyedArm(), elbowBent(30), 1);
  Pose pose = elbowBent(30);
  pose.locals[2].translation += Vec3(0, 0.1, 0);
  setKey(clip, keyedArm(), pose, 2);
  checkClip(clip, keyedArm());
  Pose between = restPose(keyedArm());
  sampleClip(clip, 1, between);
  EXPECT_NEAR(between.locals[2].translation.y(), 0, 1e-6);
  sampleClip(clip, 1.5, between);
  EXPECT_NEAR(between.locals[2].translation.y(), 0.05, 1e-6);
}

TEST(Keyframes, AKeyAtTheSameMomentReplaces) {
  Clip clip = waving();
  setKey(clip, keyedArm(), elbowBent(-10), 1 + kKeySnap / 2);
  EXPECT_EQ(keyTimes(clip).size(), 3u);
  EXPECT_NEAR(elbowAt(clip, 1 + kKeySnap / 2), -10, 1e-3);
}

// A second at 30 frames, the elbow opening evenly; corrected by 30 degrees in the middle.
TEST(Keyframes, ACorrectionComesAndGoes) {
  Clip clip;
  clip.name = "recorded";
  for (int f = 0; f <= 30; ++f) setKey(clip, keyedArm(), elbowBent(f), f / 30.0);
  const Clip before = clip;
  blendKey(clip, keyedArm(), elbowBent(15 + 30), 0.5, 0.3);
  checkClip(clip, keyedArm());
  EXPECT_THAT(keyTimes(clip), ::testing::SizeIs(31));
  EXPECT_NEAR(elbowAt(clip, 0.5), 45, 1e-3);
  double steepest = 0;
  for (int f = 0; f <= 30; ++f) {
    const double time = f / 30.0, change = elbowAt(clip, time) - elbowAt(before, time);
    if (std::abs(time - 0.5) >= 0.3) {
      EXPECT_NEAR(change, 0, 1e-3) << time;
    }
    if (f > 0) steepest = std::max(steepest, std::abs(change - (elbowAt(clip, (f - 1) / 30.0) - (f - 1))));
  }
  EXPECT_LT(steepest, 30 * 1.5 / 9 * 1.1) << "no step is steeper than a smooth one over nine frames";
  EXPECT_NEAR(elbowAt(clip, 0.5 - 0.15), elbowAt(before, 0.5 - 0.15) + 15, 1) << "half way half of it";

  Clip plain = before, none = before;
  setKey(plain, keyedArm(), elbowBent(45), 0.5);
  blendKey(none, keyedArm(), elbowBent(45), 0.5, 0);
  for (const double time : {0.4, 0.45, 0.5, 0.55}) EXPECT_EQ(elbowAt(none, time), elbowAt(plain, time));
  EXPECT_THROW(blendKey(clip, keyedArm(), elbowBent(0), 0.5, -1), Error);
}

TEST(Keyframes, MovedAndDeleted) {
  Clip clip = waving();
  moveKey(clip, 1, 4);
  checkClip(clip, keyedArm());
  EXPECT_THAT(keyTimes(clip), ElementsAre(0, 2, 4));
  EXPECT_NEAR(elbowAt(clip, 3), 40, 1e-3);
  moveKey(clip, 4, 2);
  EXPECT_THAT(keyTimes(clip), ElementsAre(0, 2));
  EXPECT_NEAR(elbowAt(clip, 2), 60, 1e-3);
  EXPECT_THROW(deleteKey(clip, 1), Error);
  EXPECT_THROW(moveKey(clip, 2, -1), Error);
  EXPECT_THROW(setKey(clip, keyedArm(), elbowBent(1), std::nan("")), Error);
  deleteKey(clip, 2);
  deleteKey(clip, 0);
  EXPECT_TRUE(keyTimes(clip).empty());
  EXPECT_EQ(clip.duration(), 0);
}

TEST(Keyframes, CurvesPassThroughTheKeysWithoutCorners) {
  Clip clip = waving();
  setKey(clip, keyedArm(), elbowBent(70), 3);
  setInterpolation(clip, Interpolation::kCubic);
  checkClip(clip, keyedArm());
  EXPECT_EQ(interpolationOf(clip), Interpolation::kCubic);
  const double h = 1e-3;
  for (const auto& [time, angle] : {std::pair(1.0, 60.0), {2.0, 20.0}, {3.0, 70.0}}) {
    EXPECT_NEAR(elbowAt(clip, time), angle, 1e-3);
  }
  const double before = (elbowAt(clip, 2) - elbowAt(clip, 2 - h)) / h,
               after = (elbowAt(clip, 2 + h) - elbowAt(clip, 2)) / h;
  EXPECT_NEAR(before, after, 1);
  EXPECT_NEAR((elbowAt(clip, h) - elbowAt(clip, 0)) / h, 0, 1);  // it sets out slowly
  // A key among them keeps the curve one, and back to straight lines nothing is lost.
  setKey(clip, keyedArm(), elbowBent(0), 2.5);
  checkClip(clip, keyedArm());
  setInterpolation(clip, Interpolation::kStep);
  EXPECT_NEAR(elbowAt(clip, 2.9), 0, 1e-3);
  EXPECT_THAT(keyTimes(clip), ElementsAre(0, 1, 2, 2.5, 3));
}

}  // namespace
}  // namespace limber
