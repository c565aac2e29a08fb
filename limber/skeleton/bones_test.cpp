#include "limber/skeleton/skeleton.h"

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"

namespace limber {
namespace {

Joint turnedJoint(const char* name, std::optional<Index> parent, const Vec3& at,
                  const Quat& rotation = Quat::Identity()) {
  return {name, parent, {at, rotation, Vec3::Ones()}, 0};
}

// A torso whose joints all have +Y along the bone: hips, spine, chest up; a thigh and an arm off to the side.
Skeleton drawnAlongY() {
  const Quat down(Eigen::AngleAxisd(kPi, Vec3::UnitX())), side(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()));
  Skeleton s;
  s.joints = {turnedJoint("hips", std::nullopt, {0, 1, 0}),   turnedJoint("spine", 0, {0, 0.2, 0}),
              turnedJoint("chest", 1, {0, 0.2, 0}),           turnedJoint("head", 2, {0, 0.3, 0}),
              turnedJoint("arm", 2, {0.1, 0.2, 0}, side),     turnedJoint("forearm", 4, {0, 0.25, 0}),
              turnedJoint("thigh", 0, {0.1, -0.05, 0}, down), turnedJoint("shin", 6, {0, 0.4, 0})};
  return s;
}

// Joints without rotation, as many tools write them.
Skeleton drawnWithoutRotations() {
  Skeleton s;
  s.joints = {turnedJoint("hips", std::nullopt, {0, 1, 0}), turnedJoint("spine", 0, {0, 0.2, 0}),
              turnedJoint("head", 1, {0, 0, 0.2}), turnedJoint("thigh", 0, {0.1, -0.1, 0}),
              turnedJoint("shin", 3, {0, -0.4, 0})};
  return s;
}

std::vector<Bone> bonesOfJoint(const Skeleton& skeleton, const char* name) {
  std::vector<Bone> bones;
  for (const Bone& bone : bonesOf(skeleton)) {
    if (bone.joint == *skeleton.find(name)) bones.push_back(bone);
  }
  return bones;
}

void expectBone(const Skeleton& skeleton, const char* name, const Vec3& a, const Vec3& b) {
  const std::vector<Bone> bones = bonesOfJoint(skeleton, name);
  ASSERT_EQ(bones.size(), 1u) << name;
  EXPECT_LT((bones[0].a - a).norm(), 1e-12) << name;
  EXPECT_LT((bones[0].b - b).norm(), 1e-12) << name << " ends at " << bones[0].b.transpose();
}

TEST(BonesOf, OfSeveralChildrenTheOneAlongTheAxisIsTheEnd) {
  expectBone(drawnAlongY(), "hips", {0, 1, 0}, {0, 1.2, 0});
  expectBone(drawnAlongY(), "chest", {0, 1.4, 0}, {0, 1.7, 0});
}

TEST(BonesOf, LeafFollowsTheAxisAsLongAsItsParentIsFar) {
  expectBone(drawnAlongY(), "forearm", {0.35, 1.6, 0}, {0.6, 1.6, 0});
  expectBone(drawnAlongY(), "shin", {0.1, 0.55, 0}, {0.1, 0.15, 0});
}

TEST(BonesOf, LeafFarFromItsParentIsCutShort) {
  Skeleton s = drawnAlongY();
  s.joints.push_back(turnedJoint("control", 0, {0, 0, 20}));
  // Single children are 0.2, 0.25 and 0.4 away.
  expectBone(s, "control", {0, 1, 20}, {0, 1 + 2.5 * 0.25, 20});
}

TEST(BonesOf, JointWhoseChildrenAllLieAsideFollowsTheAxis) {
  Skeleton s = drawnAlongY();
  s.joints[1].rest.translation = {0.12, 0.16, 0};
  expectBone(s, "hips", {0, 1, 0}, {0, 1 + 0.5 * (0.2 + std::hypot(0.1, 0.05)), 0});
}

TEST(BonesOf, WithoutACommonAxisThereIsABoneToEachChild) {
  const Skeleton s = drawnWithoutRotations();
  EXPECT_EQ(bonesOfJoint(s, "hips").size(), 2u);
  expectBone(s, "spine", {0, 1.2, 0}, {0, 1.2, 0.2});
  expectBone(s, "head", {0, 1.2, 0.2}, {0, 1.2, 0.4});
  expectBone(s, "shin", {0.1, 0.5, 0}, {0.1, 0.1, 0});
}

TEST(BonesOf, JointsThatAllStandAlikeHaveNoAxis) {
  Skeleton s;
  s.joints = {turnedJoint("root", std::nullopt, {0, 1, 0}), turnedJoint("hip", 0, {0.1, 0, 0}),
              turnedJoint("foot", 1, {0, -0.5, 0}), turnedJoint("tail", 0, {0, 0, -0.2}),
              turnedJoint("tip", 0, {0, 0.3, 0})};
  EXPECT_EQ(bonesOfJoint(s, "root").size(), 3u);
  expectBone(s, "tail", {0, 1, -0.2}, {0, 1, -0.4});
}

TEST(BonesOf, LoneJointIsAPoint) {
  Skeleton s;
  s.joints = {turnedJoint("only", std::nullopt, {1, 2, 3})};
  expectBone(s, "only", {1, 2, 3}, {1, 2, 3});
}

TEST(BonesOf, JointOnItsOnlyChildHasNone) {
  Skeleton s = drawnWithoutRotations();
  s.joints.push_back(turnedJoint("end", 4, {0, 0, 0}));
  EXPECT_TRUE(bonesOfJoint(s, "shin").empty());
}

TEST(BonesOf, AreOrderedByJoint) {
  const std::vector<Bone> bones = bonesOf(drawnWithoutRotations());
  for (std::size_t i = 1; i < bones.size(); ++i) EXPECT_LE(bones[i - 1].joint, bones[i].joint);
}

TEST(BonesOf, SpheresAreTheJointsThemselves) {
  Skeleton s = drawnAlongY();
  s.boneShape = BoneShape::kSphere;
  s.joints[1].radius = 0.3;
  ASSERT_EQ(bonesOf(s).size(), s.joints.size());
  EXPECT_EQ(bonesOf(s)[1].radius, 0.3);
  EXPECT_EQ(bonesOf(s)[1].a, bonesOf(s)[1].b);
}

}  // namespace
}  // namespace limber
