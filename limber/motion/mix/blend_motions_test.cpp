#include "limber/motion/mix/blend_motions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/core/error.h"
#include "limber/motion/mix/hold_pose.h"
#include "limber/motion/mix/testing/sample_clip.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {
namespace {

using limber::testing::jointPaths;
using limber::testing::sampleClip;

class BlendMotions : public ::testing::Test {
 protected:
  ClipWithContacts blended(const ClipWithContacts& a, const ClipWithContacts& b, double weight) const {
    return blendMotions(skeleton, a, b, {weight, std::nullopt});
  }
  // Metres a second from the first to the last frame.
  double speedOf(const Clip& clip) const {
    const auto frames = jointPaths(skeleton, clip);
    const Vec3 displacement = frames.back()[0] - frames.front()[0];
    return std::hypot(displacement.x(), displacement.z()) / clip.duration();
  }
  // The furthest that a joint of one is from that of the other.
  static double furthest(const std::vector<std::vector<Vec3>>& a, const std::vector<std::vector<Vec3>>& b) {
    double most = 0;
    for (std::size_t f = 0; f < std::min(a.size(), b.size()); ++f) {
      for (std::size_t j = 0; j < a[f].size(); ++j) most = std::max(most, (a[f][j] - b[f][j]).norm());
    }
    return most;
  }

  const Skeleton skeleton = limber::testing::sampleSkeleton();
  const ClipWithContacts walk = sampleClip("walk"), run = sampleClip("run");
};

TEST_F(BlendMotions, AMotionWithItselfIsItself) {
  for (const double weight : {0.0, 0.3, 1.0}) {
    const ClipWithContacts same = blended(walk, walk, weight);
    ASSERT_NEAR(same.clip.duration(), walk.clip.duration(), 1e-6);
    EXPECT_LT(furthest(jointPaths(skeleton, same.clip), jointPaths(skeleton, walk.clip)), 1e-4) << weight;
  }
}

TEST_F(BlendMotions, OfOneWalkAtTwoSpeedsItIsTheMiddleSpeed) {
  const ClipWithContacts slow{limber::testing::slowed(walk.clip, 2), {}};
  const double speed = speedOf(walk.clip);
  ASSERT_NEAR(speed, 1.2 / 1.1, 1e-3);
  for (const double weight : {0.25, 0.5}) {
    EXPECT_NEAR(speedOf(blended(walk, slow, weight).clip), (1 - weight / 2) * speed, 0.002 * speed);
  }
}

TEST_F(BlendMotions, TheOtherOrderIsTheSame) {
  const Clip one = blended(walk, run, 0.3).clip, other = blended(run, walk, 0.7).clip;
  EXPECT_NEAR(one.duration(), other.duration(), 1e-5);
  EXPECT_LT(furthest(jointPaths(skeleton, one), jointPaths(skeleton, other)), 1e-3);
}

// Three strides of either: a stride takes as long as the blend of strides a second says, and the result loops.
TEST_F(BlendMotions, FromWalkToRunInSteps) {
  double before = 0;
  for (const double weight : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Clip clip = blended(walk, run, weight).clip;
    const double strides = 3 * std::lerp(1 / 1.1, 1 / 0.7, weight);
    EXPECT_NEAR(clip.duration(), 9 / strides, 0.02) << weight;
    const double speed = speedOf(clip);
    EXPECT_GT(speed, before);
    before = speed;
    const MixBody body(skeleton);
    EXPECT_TRUE(MixMotion(body, {clip, {}}).loops()) << weight;
  }
  EXPECT_NEAR(before, 1.9 / 0.7, 0.02);
}

TEST_F(BlendMotions, FeetSlideNoMoreAndNothingIsRougher) {
  const double slide =
      std::max(limber::testing::toesSlide(skeleton, walk.clip), limber::testing::toesSlide(skeleton, run.clip));
  const double jerk = limber::testing::jerkOf(skeleton, run.clip);
  for (const double weight : {0.25, 0.5, 0.75}) {
    const Clip clip = blended(walk, run, weight).clip;
    EXPECT_LT(limber::testing::toesSlide(skeleton, clip), slide + 0.01) << weight;
    EXPECT_LT(limber::testing::jerkOf(skeleton, clip), 1.1 * jerk) << weight;
  }
}

// Two motions with different headings: turning is blended, not positions.
TEST_F(BlendMotions, HeadsBetweenBoth) {
  const Quat turn(Eigen::AngleAxisd(1.0, Vec3::UnitY()));
  const ClipWithContacts aside{turnClip(walk.clip, skeleton, turn), {}};
  const auto frames = jointPaths(skeleton, blended(walk, aside, 0.5).clip);
  const Vec3 displacement = frames.back()[0] - frames.front()[0];
  EXPECT_NEAR(std::atan2(displacement.x(), displacement.z()), 0.5, 0.02);
  EXPECT_NEAR(std::hypot(displacement.x(), displacement.z()), 3.6, 0.01);
}

TEST_F(BlendMotions, WhatHasNoFootfallsIsBlendedOverItsWhole) {
  Skeleton chain;
  for (Index j = 0; j < 4; ++j) {
    chain.joints.push_back({"fin" + std::to_string(j), j == 0 ? std::nullopt : std::optional<Index>(j - 1), {}, 0});
    chain.joints[j].rest.translation = {0, 0, j == 0 ? 0.0 : 0.3};
  }
  const auto bent = [&](double angle, double seconds) {
    PoseSequence frames{std::vector<Pose>(31, restPose(chain)), seconds / 30};
    for (std::size_t f = 0; f < 31; ++f) {
      frames.poses[f].locals[2].rotation = Eigen::AngleAxisd(angle * static_cast<double>(f) / 30, Vec3::UnitX());
    }
    return ClipWithContacts{clipOf(chain, frames, "bent"), {}};
  };
  const ClipWithContacts both = blendMotions(chain, bent(0.4, 1), bent(0.8, 0.5), {0.5, 60});
  EXPECT_NEAR(both.clip.duration(), 1 / 1.5, 1.0 / 60);
  Pose last = restPose(chain);
  sampleClip(both.clip, both.clip.duration(), last);
  EXPECT_NEAR(last.locals[2].rotation.angularDistance(Quat::Identity()), 0.6, 0.03);
}

TEST_F(BlendMotions, APoseIsHeldAsLongAsTheOtherLasts) {
  for (const double seconds : {0.0, 0.1, 5.0}) {
    SCOPED_TRACE(seconds);
    const ClipWithContacts pose = holdPose(skeleton, sampleClip("idle").clip, seconds, 1 / 30.0);
    Warnings warnings;
    const Clip one = blendMotions(skeleton, walk, pose, {0.5, std::nullopt}, &warnings).clip;
    EXPECT_NEAR(one.duration(), walk.clip.duration(), 1.0 / 60);
    EXPECT_NEAR(speedOf(one), speedOf(walk.clip) / 2, 0.01 * speedOf(walk.clip));
    EXPECT_TRUE(MixMotion(MixBody(skeleton), {one, {}}).loops());
    EXPECT_NEAR(blended(pose, walk, 0.5).clip.duration(), walk.clip.duration(), 1.0 / 60);
    EXPECT_TRUE(warnings.empty());
  }
  const ClipWithContacts pose = holdPose(skeleton, walk.clip, 0, 1 / 30.0);
  Warnings warnings;
  EXPECT_EQ(blendMotions(skeleton, pose, pose, {0.5, std::nullopt}, &warnings).clip.duration(), 0);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(BlendMotions, OfWhatIsMuchFasterItIsWarned) {
  const ClipWithContacts shortOne{trimClip(walk.clip, 0, 0.1), {}};
  Warnings warnings;
  blendMotions(skeleton, walk, run, {0.5, std::nullopt}, &warnings);
  blendMotions(skeleton, walk, shortOne, {0, std::nullopt}, &warnings);
  EXPECT_TRUE(warnings.empty());
  blendMotions(skeleton, walk, shortOne, {0.5, std::nullopt}, &warnings);
  ASSERT_EQ(warnings.items().size(), 1u);
  EXPECT_EQ(warnings.items()[0].kind, "unlike-rates");
  EXPECT_NE(warnings.items()[0].message.find("factor of 33"), std::string::npos) << warnings.items()[0].message;
}

TEST_F(BlendMotions, AWeightOutsideIsRefused) {
  EXPECT_THROW(blended(walk, run, 1.5), Error);
  EXPECT_THROW(blended(walk, run, std::nan("")), Error);
}

}  // namespace
}  // namespace limber
