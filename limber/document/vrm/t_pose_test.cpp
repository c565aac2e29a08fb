#include "limber/document/vrm/t_pose.h"

#include <gtest/gtest.h>

#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/vrm/testing/avatars.h"
#include "limber/document/vrm/vrm_bones.h"
#include "limber/document/vrm/vrm_write.h"

namespace limber {
namespace {

Asset posedVrm(const char* joint, const Vec3& axis, double degrees) {
  Asset asset = testing::avatarOf(testing::mixamoPerson());
  makeVrm(asset);
  const AssetSkeleton rig = readSkeleton(asset);
  Pose pose = readNodePose(asset, rig);
  Quat& rotation = pose.locals[rig.skeleton.find(joint).value()].rotation;
  rotation = rotation * testing::turn(axis, degrees);
  writeNodePose(asset, rig, pose);
  return asset;
}

TEST(RestsInTPose, GoesByLimbsAndTrunk) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  EXPECT_TRUE(restsInTPose(posedVrm("mixamorig:LeftForeArm", y, 10), kVrmName));
  EXPECT_FALSE(restsInTPose(posedVrm("mixamorig:LeftForeArm", y, 30), kVrmName));
  EXPECT_FALSE(restsInTPose(posedVrm("mixamorig:RightUpLeg", x, -40), kVrmName));
  EXPECT_FALSE(restsInTPose(posedVrm("mixamorig:Spine", x, 60), kVrmName));
  EXPECT_FALSE(restsInTPose(posedVrm("mixamorig:Hips", y, 90), kVrmName));
  EXPECT_FALSE(restsInTPose(posedVrm("mixamorig:Hips", y, 0), kVrm0Name));  // is none
}

TEST(RestsInTPose, GoesByTheBindPoseForWhatPointsAnywhere) {
  for (const char* joint : {"mixamorig:Head", "mixamorig:LeftHand", "mixamorig:RightToeBase"}) {
    EXPECT_TRUE(restsInTPose(posedVrm(joint, Vec3::UnitX(), 10), kVrmName)) << joint;
    EXPECT_FALSE(restsInTPose(posedVrm(joint, Vec3::UnitX(), 30), kVrmName)) << joint;
  }
}

TEST(VrmRestPose, OfAPosedVrmIsATPose) {
  Asset asset = testing::avatarOf(testing::mixamoPerson());
  makeVrm(asset);
  const AssetSkeleton rig = readSkeleton(asset);
  Warnings warnings;
  const std::vector<HumanoidJoint> bones = vrmBones(asset, rig, warnings);
  const Pose standing = readNodePose(asset, rig);
  EXPECT_EQ(vrmRestPose(asset, rig, bones).pose.locals[0].rotation, standing.locals[0].rotation);
  Pose pose = standing;
  pose.locals[rig.skeleton.find("mixamorig:LeftForeArm").value()].rotation = testing::turn(Vec3::UnitY(), 60);
  writeNodePose(asset, rig, pose);
  const std::vector<Vec3> expected = posePositions(rig.skeleton, standing),
                          positions = posePositions(rig.skeleton, vrmRestPose(asset, rig, bones).pose);
  for (const HumanoidJoint& bone : bones) {
    EXPECT_LT((positions[bone.joint] - expected[bone.joint]).norm(), 1e-6) << bone.bone;
  }
}

}  // namespace
}  // namespace limber
