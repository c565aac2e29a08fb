#include "limber/character/matching/plain_skeleton.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::walk;
using limber::testing::withOtherAxes;

double largestDistance(const Skeleton& a, const PoseSequence& one, const Skeleton& b, const PoseSequence& other) {
  double largest = 0;
  for (std::size_t f = 0; f < one.poses.size(); ++f) {
    const std::vector<Affine> x = poseGlobals(a, one.poses[f]), y = poseGlobals(b, other.poses[f]);
    for (Index j = 0; j < a.jointCount(); ++j) {
      largest = std::max(largest, (x[j].translation() - y[j].translation()).norm());
    }
  }
  return largest;
}

// Turned about and mirrored here and there.
Skeleton mirroredPerson() {
  Skeleton person = withOtherAxes(practiceHumanoid());
  person.joints[0].rest.scale = Vec3(-2, 2, 2);
  person.joints[person.find("spine").value()].rest.scale = Vec3(1, -1, -1);
  person.joints[person.find("leftUpperArm").value()].rest.scale = Vec3(0.5, 0.5, -0.5);
  return person;
}

PoseSequence turning(const Skeleton& person) {
  PoseSequence motion;
  for (int f = 0; f < 5; ++f) {
    motion.poses.push_back(restPose(person));
    for (Index j = 0; j < person.jointCount(); ++j) {
      Quat& rotation = motion.poses.back().locals[j].rotation;
      rotation = rotation * fromRotationVector(0.2 * f * Vec3(std::sin(j), std::cos(j), 0.3));
    }
  }
  return motion;
}

TEST(PlainSkeleton, EveryJointIsWhereItIsInTheMirroredOne) {
  const Skeleton person = mirroredPerson();
  const PlainSkeleton plain(person);
  for (const Joint& joint : plain.skeleton().joints) EXPECT_GT(joint.rest.scale.minCoeff(), 0);
  const PoseSequence motion = turning(person), same = plain.plain(motion);
  EXPECT_LT(largestDistance(person, motion, plain.skeleton(), same), 1e-12);
  EXPECT_LT(largestDistance(person, motion, person, plain.original(same)), 1e-12);
}

TEST(PlainSkeleton, WithoutScalesNothingChanges) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = walk(person, 3);
  const PoseSequence same = PlainSkeleton(person).plain(motion);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    for (Index j = 0; j < person.jointCount(); ++j) {
      EXPECT_EQ(same.poses[f].locals[j].rotation.coeffs(), motion.poses[f].locals[j].rotation.coeffs());
      EXPECT_EQ(same.poses[f].locals[j].translation, motion.poses[f].locals[j].translation);
    }
  }
}

// As something that grows out of nothing does.
TEST(PlainSkeleton, ScalesThatChangeTakeJointsAlong) {
  const Skeleton person = practiceHumanoid();
  PoseSequence motion = turning(person);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    motion.poses[f].locals[0].scale *= 0.25 * static_cast<double>(f);
    motion.poses[f].locals[person.find("chest").value()].scale *= 1.5;
  }
  const PlainSkeleton plain(person);
  EXPECT_LT(largestDistance(person, motion, plain.skeleton(), plain.plain(motion)), 1e-9);
}

}  // namespace
}  // namespace limber
