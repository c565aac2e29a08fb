#include "limber/matching/plain_skeleton.h"

#include <gtest/gtest.h>

#include "limber/matching/testing/test_motion.h"

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

// The practice humanoid below a node that scales.
Skeleton belowArmature(const Vec3& scale) {
  Skeleton person = withOtherAxes(practiceHumanoid());
  Joint armature;
  armature.name = "armature";
  armature.rest.scale = scale;
  for (Joint& joint : person.joints) joint.parent = joint.parent ? *joint.parent + 1 : 0;
  person.joints.insert(person.joints.begin(), armature);
  return person;
}

// A whole person mirrored: what is named right is now on the left. It walks forward all the same.
TEST(PlainSkeleton, AMirroredPersonMovesAsTheOtherDoes) {
  const Skeleton person = practiceHumanoid(), other = belowArmature(Vec3::Ones());
  const Skeleton mirrored = belowArmature(Vec3(-1, 1, 1));
  const Clip clip = clipOf(person, walk(person), "walk");
  const SkeletonMap map = matchSkeletons(person, other), mirroredMap = matchSkeletons(person, mirrored);
  EXPECT_EQ(mirrored.joints[mirroredMap.find("leftFoot")->target.front()].name, "rightFoot");
  for (const RetargetMethod& method : retargetMethods()) {
    if (method.name == "copy") continue;
    SCOPED_TRACE(method.name);
    const PoseSequence moved = sampleFrames(other, retargetClip(method, person, clip, other, map, {}, 60), 60);
    const PoseSequence result =
        sampleFrames(mirrored, retargetClip(method, person, clip, mirrored, mirroredMap, {}, 60), 60);
    ASSERT_EQ(moved.poses.size(), result.poses.size());
    double largest = 0;
    for (std::size_t f = 0; f < moved.poses.size(); ++f) {
      const std::vector<Affine> a = poseGlobals(other, moved.poses[f]), b = poseGlobals(mirrored, result.poses[f]);
      for (const JointMatch& match : map.matches) {
        if (match.part.ends_with("End")) continue;  // matched by its name alone, which changed sides
        const Index joint = mirroredMap.find(match.part)->target.front();
        largest = std::max(largest, (a[match.target.front()].translation() - b[joint].translation()).norm());
      }
    }
    EXPECT_LT(largest, 1e-4);
  }
}

TEST(PlainSkeleton, EveryMethodTakesUnevenScales) {
  const Skeleton person = practiceHumanoid();
  Skeleton uneven = person;
  uneven.joints[uneven.find("spine").value()].rest.scale = Vec3(1.00002, 1, 0.99999);
  const Clip clip = clipOf(person, walk(person, 30), "walk");
  const SkeletonMap map = matchSkeletons(person, uneven);
  for (const RetargetMethod& method : retargetMethods()) {
    SCOPED_TRACE(method.name);
    const PoseSequence moved = sampleFrames(uneven, retargetClip(method, person, clip, uneven, map, {}, 60), 60);
    EXPECT_LT(largestDistance(person, sampleFrames(person, clip, 60), uneven, moved), 1e-3);
  }
}

}  // namespace
}  // namespace limber
