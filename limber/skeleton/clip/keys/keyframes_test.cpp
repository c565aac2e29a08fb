#include "limber/skeleton/clip/keys/keyframes.h"

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

TEST(Keyframes, ManyPosesGiveTheClipOfOneByOne) {
  std::vector<Pose> poses;
  std::vector<double> seconds;
  Clip wanted;
  for (int k = 0; k < 30; ++k) {
    poses.push_back(elbowBent(k < 3 ? 0 : 20 * k));
    poses.back().locals[2].translation.y() = k > 10 ? 0.1 * k : 0;
    seconds.push_back(k == 20 ? 3.6101 : k * k * 0.01);  // one of two keys at the same time
    setKey(wanted, keyedArm(), poses.back(), seconds.back());
  }
  const Clip clip = clipOfKeys(keyedArm(), poses, seconds);
  checkClip(clip, keyedArm());
  EXPECT_EQ(keyTimes(clip), keyTimes(wanted));
  EXPECT_EQ(clip.translations.size(), wanted.translations.size());
  EXPECT_EQ(clip.rotations.size(), wanted.rotations.size());
  for (double time = 0; time < 8.5; time += 0.03) {
    Pose a = restPose(keyedArm()), b = a;
    sampleClip(clip, time, a);
    sampleClip(wanted, time, b);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_LT((a.locals[j].translation - b.locals[j].translation).norm(), 1e-6);
      EXPECT_LT(a.locals[j].rotation.angularDistance(b.locals[j].rotation), 1e-6);
    }
  }
  const std::vector<Eigen::Quaternionf>& turns = clip.rotations.back().values;
  for (std::size_t k = 1; k < turns.size(); ++k) EXPECT_GE(turns[k].dot(turns[k - 1]), 0);
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

// Of the elbow alone: the root keeps its keys.
TEST(Keyframes, KeysOfOneJointAreScaledCopiedAndDeleted) {
  Clip clip = waving();
  const auto elbowTimes = [&] { return keyTimesOfJoints(clip)[1].seconds; };
  const std::vector<JointKey> later = {{1, 1}, {1, 2}};
  retimeKeys(clip, later, {.shift = 0.5, .scale = 2, .pivot = 1});
  checkClip(clip, keyedArm());
  EXPECT_THAT(elbowTimes(), ElementsAre(0, 1.5, 3.5));
  EXPECT_THAT(keyTimesOfJoints(clip)[0].seconds, ElementsAre(0, 1, 2));
  EXPECT_NEAR(elbowAt(clip, 1.5), 60, 1e-3);
  EXPECT_NEAR(elbowAt(clip, 3.5), 20, 1e-3);

  retimeKeys(clip, std::vector<JointKey>{{1, 0}, {1, 1.5}}, {.shift = 2, .copy = true});
  EXPECT_THAT(elbowTimes(), ElementsAre(0, 1.5, 2, 3.5)) << "the copy at 3.5 took the place of the key there";
  EXPECT_NEAR(elbowAt(clip, 3.5), 60, 1e-3);

  const Clip before = clip;
  EXPECT_THROW(retimeKeys(clip, std::vector<JointKey>{{1, 1}}, {.shift = 1}), Error) << "no key is there";
  EXPECT_THROW(retimeKeys(clip, std::vector<JointKey>{{2, 0}}, {.shift = 1}), Error) << "that joint has none";
  EXPECT_THROW(retimeKeys(clip, std::vector<JointKey>{{1, 1.5}}, {.shift = -2}), Error);
  EXPECT_THROW(retimeKeys(clip, std::vector<JointKey>{{1, 1.5}}, {.scale = 0}), Error);
  EXPECT_THROW(deleteKeys(clip, std::vector<JointKey>{{1, 0}, {1, 1}}), Error);
  EXPECT_THAT(keyTimesOfJoints(clip)[1].seconds, ::testing::ContainerEq(keyTimesOfJoints(before)[1].seconds));
  deleteKeys(clip, std::vector<JointKey>{{1, 0}, {1, 1.5}, {1, 2}, {1, 3.5}});
  EXPECT_EQ(clip.rotations.size(), 1u) << "a joint without keys has no track";
}

TEST(Keyframes, CurvesStayCurvesWhenKeysMove) {
  Clip clip = waving();
  setInterpolation(clip, Interpolation::kCubic);
  retimeKeys(clip, std::vector<JointKey>{{1, 1}}, {.shift = 0.5});
  checkClip(clip, keyedArm());
  EXPECT_EQ(interpolationOf(clip), Interpolation::kCubic);
  EXPECT_NEAR(elbowAt(clip, 1.5), 60, 1e-3);
  deleteKeys(clip, std::vector<JointKey>{{1, 1.5}});
  checkClip(clip, keyedArm());
}

// Of all joints that have one then.
std::vector<JointKey> keysAt(const Clip& clip, double seconds) {
  std::vector<JointKey> keys;
  for (const auto& [joint, times] : keyTimesOfJoints(clip)) {
    if (std::find(times.begin(), times.end(), seconds) != times.end()) keys.push_back({joint, seconds});
  }
  return keys;
}

TEST(Keyframes, MovedAndDeleted) {
  Clip clip = waving();
  retimeKeys(clip, keysAt(clip, 1), {.shift = 3});
  checkClip(clip, keyedArm());
  EXPECT_THAT(keyTimes(clip), ElementsAre(0, 2, 4));
  EXPECT_NEAR(elbowAt(clip, 3), 40, 1e-3);
  retimeKeys(clip, keysAt(clip, 4), {.shift = -2});
  EXPECT_THAT(keyTimes(clip), ElementsAre(0, 2));
  EXPECT_NEAR(elbowAt(clip, 2), 60, 1e-3);
  EXPECT_THROW(retimeKeys(clip, keysAt(clip, 2), {.shift = -3}), Error);
  EXPECT_THROW(setKey(clip, keyedArm(), elbowBent(1), std::nan("")), Error);
  deleteKeys(clip, keysAt(clip, 2));
  deleteKeys(clip, keysAt(clip, 0));
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
