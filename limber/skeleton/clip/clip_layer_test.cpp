#include "limber/skeleton/clip/clip_layer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

Skeleton layeredArm() {
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

Quat bentBy(double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * EIGEN_PI / 180, Vec3::UnitZ()));
}

// Two seconds at 30 frames, the elbow opening by 30 degrees a second.
Clip opening(Interpolation between = Interpolation::kLinear) {
  Clip clip;
  clip.name = "opening";
  Track<Eigen::Quaternionf> elbow;
  elbow.joint = 1;
  for (int f = 0; f <= 60; ++f) {
    elbow.times.push_back(static_cast<float>(f / 30.0));
    elbow.values.push_back(bentBy(f).cast<float>());
  }
  clip.rotations.push_back(elbow);
  setInterpolation(clip, between);
  return clip;
}

Pose poseOf(const Clip& clip, double seconds) {
  Pose pose = restPose(layeredArm());
  sampleClip(clip, seconds, pose);
  return pose;
}

double elbowDegrees(const Clip& clip, double seconds) {
  const Quat q = poseOf(clip, seconds).locals[1].rotation;
  return 2 * std::atan2(q.z(), q.w()) * 180 / EIGEN_PI;
}

// Of the elbow, by so many degrees beyond what the clip has.
void correct(ClipLayer& layer, const Clip& clip, double seconds, double span, double degrees) {
  const Pose base = poseOf(clip, seconds), shown = poseOf(applyLayer(clip, layer, layeredArm()), seconds);
  Pose pose = shown;
  pose.locals[1].rotation = base.locals[1].rotation * bentBy(degrees);
  setKey(layer, base, shown, pose, seconds, span);
}

double offsetDegrees(const Clip& clip, const ClipLayer& layer, double seconds) {
  return elbowDegrees(applyLayer(clip, layer, layeredArm()), seconds) - elbowDegrees(clip, seconds);
}

TEST(ClipLayer, ACorrectionFadesInAndOut) {
  for (const Interpolation between : {Interpolation::kLinear, Interpolation::kCubic}) {
    const Clip clip = opening(between);
    ClipLayer layer;
    correct(layer, clip, 1, 0.3, 20);
    const Clip result = applyLayer(clip, layer, layeredArm());
    checkClip(result, layeredArm());
    EXPECT_EQ(interpolationOf(result), between);
    EXPECT_NEAR(offsetDegrees(clip, layer, 1), 20, 1e-3);
    EXPECT_NEAR(offsetDegrees(clip, layer, 0.85), 10, 0.3) << "half way half of it";
    EXPECT_NEAR(offsetDegrees(clip, layer, 1.15), 10, 0.3);
    for (const double away : {0.3, 0.5, 0.9}) {
      EXPECT_NEAR(offsetDegrees(clip, layer, 1 - away), 0, 0.05);
      EXPECT_NEAR(offsetDegrees(clip, layer, 1 + away), 0, 0.05);
    }
  }
}

TEST(ClipLayer, NothingOutsideItsReachChangesByABit) {
  const Clip clip = opening();
  ClipLayer layer;
  correct(layer, clip, 1, 0.3, 20);
  const Clip result = applyLayer(clip, layer, layeredArm());
  const Track<Eigen::Quaternionf>&was = clip.rotations[0], &is = result.rotations[0];
  int kept = 0;
  for (std::size_t k = 0; k < was.times.size(); ++k) {
    if (std::abs(was.times[k] - 1) < 0.31) continue;
    const auto at = std::find(is.times.begin(), is.times.end(), was.times[k]);
    ASSERT_NE(at, is.times.end());
    EXPECT_EQ(is.values[static_cast<std::size_t>(at - is.times.begin())].coeffs(), was.values[k].coeffs());
    ++kept;
  }
  EXPECT_GT(kept, 40);
  EXPECT_EQ(result.duration(), clip.duration());
}

TEST(ClipLayer, BetweenKeysThatMeetTheCorrectionStays) {
  const Clip clip = opening();
  ClipLayer near, far;
  correct(near, clip, 0.6, 0.3, 20);
  correct(near, clip, 1.1, 0.3, 20);
  EXPECT_NEAR(offsetDegrees(clip, near, 0.85), 20, 0.01);
  correct(far, clip, 0.5, 0.3, 20);
  correct(far, clip, 1.5, 0.3, -10);
  EXPECT_NEAR(offsetDegrees(clip, far, 1), 0, 0.01);
  EXPECT_NEAR(offsetDegrees(clip, far, 0.5), 20, 0.01);
  EXPECT_NEAR(offsetDegrees(clip, far, 1.5), -10, 0.01);
}

// Spans of different length: none of them is cut off.
TEST(ClipLayer, NothingJumps) {
  const Clip clip = opening();
  for (const auto& [second, longSpan, shortSpan] :
       {std::tuple(1.9, 0.9, 0.1), {1.2, 0.9, 0.1}, {1.2, 0.1, 0.9}, {0.4, 0.05, 0.05}}) {
    ClipLayer layer;
    correct(layer, clip, 0.3, longSpan, 20);
    correct(layer, clip, second, shortSpan, 20);
    const Clip result = applyLayer(clip, layer, layeredArm());
    for (double time = 0.005; time < 2; time += 0.005) {
      EXPECT_LT(std::abs(elbowDegrees(result, time) - elbowDegrees(result, time - 0.005)),
                0.005 * (30 + 1.7 * 20 / std::min(longSpan, shortSpan)))
          << time << " with the second at " << second;
    }
  }
}

TEST(ClipLayer, OnlyWhatWasCorrectedGetsAKey) {
  const Clip clip = opening();
  ClipLayer layer;
  correct(layer, clip, 1, 0.3, 20);
  Pose base = poseOf(clip, 0.5), shown = poseOf(applyLayer(clip, layer, layeredArm()), 0.5), pose = shown;
  pose.locals[2].translation += Vec3(0, 0.1, 0);
  setKey(layer, base, shown, pose, 0.5, 0.2);
  ASSERT_EQ(layer.tracks.size(), 2u);
  EXPECT_EQ(layer.tracks[0].keys.size(), 1u);
  const Clip result = applyLayer(clip, layer, layeredArm());
  checkClip(result, layeredArm());
  ASSERT_EQ(result.translations.size(), 1u) << "the hand gets a track, at rest where nothing was corrected";
  EXPECT_NEAR(poseOf(result, 0.5).locals[2].translation.y(), 0.1, 1e-6);
  EXPECT_NEAR(poseOf(result, 1).locals[2].translation.y(), 0, 1e-6);
  // The same pose again: every joint of the layer gets a key that keeps it there.
  base = poseOf(clip, 1.2);
  shown = poseOf(result, 1.2);
  setKey(layer, base, shown, shown, 1.2, 0.2);
  EXPECT_THAT(keyTimes(layer), ElementsAre(0.5, 1, 1.2));
  EXPECT_EQ(layer.tracks[0].keys.size(), 2u);
  EXPECT_EQ(layer.tracks[1].keys.size(), 2u);
}

TEST(ClipLayer, WithoutSpanOneMomentAloneIsCorrected) {
  const Clip clip = opening();
  ClipLayer layer;
  correct(layer, clip, 1, 0, 20);
  EXPECT_NEAR(offsetDegrees(clip, layer, 1), 20, 1e-3);
  EXPECT_NEAR(offsetDegrees(clip, layer, 1 - 1 / 30.0), 0, 1e-3);
  EXPECT_NEAR(offsetDegrees(clip, layer, 1 + 1 / 30.0), 0, 1e-3);
}

TEST(ClipLayer, SpansBeyondTheClipCostNothing) {
  const Clip clip = opening();
  ClipLayer layer;
  correct(layer, clip, 2, 1e12, 20);
  const Clip result = applyLayer(clip, layer, layeredArm());
  EXPECT_EQ(result.duration(), clip.duration());
  EXPECT_NEAR(offsetDegrees(clip, layer, 2), 20, 1e-3);
  EXPECT_LT(result.rotations[0].times.size(), 70u);
}

TEST(ClipLayer, BadKeysChangeNothing) {
  const Clip clip = opening();
  const Pose pose = poseOf(clip, 1);
  ClipLayer layer;
  EXPECT_THROW(setKey(layer, pose, pose, pose, -1, 0.1), Error);
  EXPECT_THROW(setKey(layer, pose, pose, pose, 1, -0.1), Error);
  EXPECT_THROW(setKey(layer, pose, pose, {}, 1, 0.1), Error);
  correct(layer, clip, 1, 0.3, 20);
  EXPECT_THROW(deleteKeys(layer, std::vector<JointKey>{{1, 1}, {1, 1.5}}), Error);
  EXPECT_THROW(retimeKeys(layer, std::vector<JointKey>{{1, 1}}, {.shift = -2}), Error);
  EXPECT_THAT(keyTimes(layer), ElementsAre(1));
  retimeKeys(layer, std::vector<JointKey>{{1, 1}}, {.shift = -0.5});
  EXPECT_THAT(keyTimes(layer), ElementsAre(0.5));
  deleteKeys(layer, std::vector<JointKey>{{1, 0.5}});
  EXPECT_TRUE(layer.empty());
}

}  // namespace
}  // namespace limber
