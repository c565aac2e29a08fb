#include "limber/motion/mix/hold_pose.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/motion/mix/testing/sample_clip.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {
namespace {

using limber::testing::sampleClip;

TEST(HoldPose, WhatDoesNotMoveIsStillHoweverLongItLasts) {
  const Skeleton skeleton = limber::testing::sampleSkeleton();
  const Clip walk = sampleClip("walk").clip, clip = holdPose(skeleton, walk, 2, 1 / 30.0).clip;
  EXPECT_FALSE(isStill(walk));
  EXPECT_TRUE(isStill(clip));
  EXPECT_TRUE(isStill(Clip{}));
  EXPECT_TRUE(isStill(holdPose(skeleton, walk, 0, 1 / 30.0).clip));
}

TEST(HoldPose, IsTheFirstPoseForAsLongAsAskedFor) {
  const Skeleton skeleton = limber::testing::sampleSkeleton();
  const Clip walk = sampleClip("walk").clip;
  EXPECT_NEAR(holdPose(skeleton, walk, 0.3, 1 / 30.0).clip.duration(), 0.3, 1e-6);
  const Clip clip = holdPose(skeleton, walk, 0.31, 1 / 30.0).clip;
  EXPECT_NEAR(clip.duration(), 1 / 3.0, 1e-6);
  Pose first = restPose(skeleton), last = first;
  limber::sampleClip(walk, 0, first);
  limber::sampleClip(clip, clip.duration(), last);
  EXPECT_LT((posePositions(skeleton, first).back() - posePositions(skeleton, last).back()).norm(), 1e-5);
  EXPECT_THROW(holdPose(skeleton, walk, 1e300, 1 / 30.0), Error);
}

}  // namespace
}  // namespace limber
