#include "limber/motion/retarget/copy_rotations.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

PoseSequence copied(const Skeleton& source, const Skeleton& target, const PoseSequence& motion) {
  const RetargetSetup setup(source, target, matchSkeletons(source, target), {}, &motion);
  return retargetFrames(findRetargetMethod("copy"), setup, motion);
}

TEST(CopyRotations, LikeSkeletonsMoveAlike) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = limber::testing::walk(person, 30), result = copied(person, person, motion);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const std::vector<Affine> expected = poseGlobals(person, motion.poses[f]);
    const std::vector<Affine> given = poseGlobals(person, result.poses[f]);
    for (Index j = 0; j < person.jointCount(); ++j) {
      ASSERT_LT((expected[j].translation() - given[j].translation()).norm(), 1e-6);
    }
  }
}

// It copies the tracks' values, whatever the bones' lengths.
TEST(CopyRotations, RotationsAreTheSourcesOwn) {
  const Skeleton person = practiceHumanoid(), odd = limber::testing::oddlyBuilt();
  const PoseSequence motion = limber::testing::walk(person, 30), result = copied(person, odd, motion);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    for (Index j = 0; j < person.jointCount(); ++j) {
      const Quat &a = motion.poses[f].locals[j].rotation, &b = result.poses[f].locals[j].rotation;
      ASSERT_GT(std::abs(a.dot(b)), 1 - 1e-9) << person.joints[j].name;
    }
  }
}

}  // namespace
}  // namespace limber
