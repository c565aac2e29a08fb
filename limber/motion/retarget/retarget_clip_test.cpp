#include "limber/motion/retarget/retarget_clip.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/skeleton/motion.h"

namespace limber {
namespace {

TEST(RetargetClip, SamplingGivesBackTheFrames) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = limber::testing::walk(person, 40);
  const Clip clip = clipOf(person, motion, "walk");
  EXPECT_NEAR(frameRateOf(clip), 60, 1e-3);
  const PoseSequence again = sampleFrames(person, clip, 60);
  ASSERT_EQ(again.poses.size(), motion.poses.size());
  for (std::size_t f = 0; f < again.poses.size(); ++f) {
    for (Index j = 0; j < person.jointCount(); ++j) {
      const Transform &a = again.poses[f].locals[j], &b = motion.poses[f].locals[j];
      ASSERT_LT((a.translation - b.translation).norm(), 1e-5);
      ASSERT_GT(std::abs(a.rotation.dot(b.rotation)), 1 - 1e-6);
    }
  }
}

TEST(RetargetClip, StandingStillLastsAsLong) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence still{std::vector<Pose>(31, restPose(person)), 1.0 / 30};
  const Clip clip = clipOf(person, still, "still");
  EXPECT_NEAR(clip.duration(), 1, 1e-6);
  EXPECT_NEAR(frameRateOf(clip), 30, 1e-3);
  checkClip(clip, person);
  const Clip there = retargetClip(findRetargetMethod("limb-ik"), person, clip, limber::testing::scaled(person, 2),
                                  matchSkeletons(person, person), {}, 0);
  EXPECT_NEAR(there.duration(), 1, 1e-6);
}

// The practice humanoid below a node that scales.
Skeleton belowArmature(const Vec3& scale) {
  Skeleton person = limber::testing::withOtherAxes(practiceHumanoid());
  Joint armature;
  armature.name = "armature";
  armature.rest.scale = scale;
  for (Joint& joint : person.joints) joint.parent = joint.parent ? *joint.parent + 1 : 0;
  person.joints.insert(person.joints.begin(), armature);
  return person;
}

// A whole person mirrored: what is named right is now on the left. It walks forward all the same.
TEST(RetargetClip, AMirroredPersonMovesAsTheOtherDoes) {
  const Skeleton person = practiceHumanoid(), upright = belowArmature(Vec3::Ones());
  const Skeleton mirrored = belowArmature(Vec3(-1, 1, 1));
  const Clip clip = clipOf(person, limber::testing::walk(person), "walk");
  const SkeletonMap map = matchSkeletons(person, upright), mirroredMap = matchSkeletons(person, mirrored);
  EXPECT_EQ(mirrored.joints[mirroredMap.find(body_part::leg(Side::kLeft, Segment::kEnd))->target.front()].name,
            "rightFoot");
  for (const RetargetMethod& method : retargetMethods()) {
    if (method.name == "copy") continue;
    SCOPED_TRACE(method.name);
    const PoseSequence moved = sampleFrames(upright, retargetClip(method, person, clip, upright, map, {}, 60), 60);
    const PoseSequence result =
        sampleFrames(mirrored, retargetClip(method, person, clip, mirrored, mirroredMap, {}, 60), 60);
    ASSERT_EQ(moved.poses.size(), result.poses.size());
    double largest = 0;
    for (std::size_t f = 0; f < moved.poses.size(); ++f) {
      const std::vector<Affine> a = poseGlobals(upright, moved.poses[f]), b = poseGlobals(mirrored, result.poses[f]);
      for (const JointMatch& match : map.matches) {
        if (match.part.kind == PartKind::kOther) continue;  // matched by its name alone, which changed sides
        const JointMatch* other = mirroredMap.find(match.part);
        ASSERT_TRUE(other) << nameOf(match.part);
        const Vec3 here = a[match.target.front()].translation(), there = b[other->target.front()].translation();
        largest = std::max(largest, (here - there).norm());
      }
    }
    EXPECT_LT(largest, 1e-4);
  }
}

TEST(RetargetClip, EveryMethodTakesUnevenScales) {
  const Skeleton person = practiceHumanoid();
  Skeleton uneven = person;
  uneven.joints[uneven.find("spine").value()].rest.scale = Vec3(1.00002, 1, 0.99999);
  const Clip clip = clipOf(person, limber::testing::walk(person, 30), "walk");
  const SkeletonMap map = matchSkeletons(person, uneven);
  for (const RetargetMethod& method : retargetMethods()) {
    SCOPED_TRACE(method.name);
    const PoseSequence moved = sampleFrames(uneven, retargetClip(method, person, clip, uneven, map, {}, 60), 60);
    const PoseSequence before = sampleFrames(person, clip, 60);
    for (std::size_t f = 0; f < moved.poses.size(); ++f) {
      const std::vector<Affine> from = poseGlobals(person, before.poses[f]), to = poseGlobals(uneven, moved.poses[f]);
      for (Index j = 0; j < person.jointCount(); ++j)
        EXPECT_LT((from[j].translation() - to[j].translation()).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace limber
