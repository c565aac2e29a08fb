#include "limber/document/clip/pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

PortablePose hipsAndHead() {
  PortablePose pose;
  pose.name = "wave \xC3\xA9";
  pose.skeleton.joints.resize(2);
  pose.skeleton.joints[0].name = "hips";
  pose.skeleton.joints[0].declaredBone = humanoidBones()[0];
  pose.skeleton.joints[0].rest.translation = Vec3(0, 1.0 / 3, 1e-17);
  pose.skeleton.joints[1].name = "head";
  pose.skeleton.joints[1].parent = 0;
  pose.skeleton.joints[1].rest.rotation = Quat(Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()));
  pose.pose = restPose(pose.skeleton);
  pose.pose.locals[1].rotation = Quat(Eigen::AngleAxisd(-0.4, Vec3(3, 2, 3).normalized()));
  pose.pose.locals[1].scale = Vec3(1, 2, -0.5);
  return pose;
}

void expectBitsOf(const Transform& a, const Transform& b) {
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  EXPECT_EQ(a.scale, b.scale);
}

TEST(PoseFile, ComesBackBitForBit) {
  const PortablePose pose = hipsAndHead(), read = poseFromJson(poseToJson(pose));
  EXPECT_EQ(read.name, pose.name);
  ASSERT_EQ(read.skeleton.jointCount(), 2u);
  EXPECT_EQ(read.skeleton.joints[1].parent, std::optional<Index>(0));
  for (Index j = 0; j < 2; ++j) {
    EXPECT_EQ(read.skeleton.joints[j].name, pose.skeleton.joints[j].name);
    EXPECT_EQ(read.skeleton.joints[j].declaredBone, pose.skeleton.joints[j].declaredBone);
    expectBitsOf(read.skeleton.joints[j].rest, pose.skeleton.joints[j].rest);
    expectBitsOf(read.pose.locals[j], pose.pose.locals[j]);
  }
}

std::string poseRefusal(const std::string& text) {
  try {
    poseFromJson(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PoseFile, SaysWhatIsWrongAndWhere) {
  const auto joints = [](const std::string& list) { return R"({"limber_pose": 1, "joints": [)" + list + "]}"; };
  EXPECT_THAT(poseRefusal("hello"), HasSubstr("JSON"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "bone": "arm"})")), HasSubstr("is no bone of VRM 1.0"));
  EXPECT_THAT(poseRefusal("[1]"), HasSubstr("no pose that limber knows"));
  EXPECT_THAT(poseRefusal(R"({"limber_pose": 2})"), HasSubstr("save one in the studio"));
  EXPECT_THAT(poseRefusal(R"({"limber_pose": 1})"), HasSubstr("has no \"joints\""));
  EXPECT_THAT(poseRefusal(joints("{}")), HasSubstr("joints[0]: has no \"name\""));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a"}, {"name": "a"})")), HasSubstr("name of another"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "parent": "b"}, {"name": "b"})")), HasSubstr("no joint before"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "parent": "a"})")), HasSubstr("no joint before"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "colour": 1})")), HasSubstr("joints[0].colour"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "rest": {"rotation": [1, 1, 0, 0]}})")), HasSubstr("unit length"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "rest": {"scale": [1, 0, 1]}})")), HasSubstr("too small"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "local": {"translation": [1, 2]}})")), HasSubstr("3 numbers"));
  EXPECT_THAT(poseRefusal(joints(R"({"name": "a", "local": {"translation": [1e30, 2, 1]}})")), HasSubstr("too large"));
  EXPECT_THAT(poseRefusal(std::string(5'000'000, ' ')), HasSubstr("4 MB"));
  std::string many;
  for (int j = 0; j < 2001; ++j) many += (j ? ", {\"name\": \"" : "{\"name\": \"") + std::to_string(j) + "\"}";
  EXPECT_THAT(poseRefusal(joints(many)), HasSubstr("2000"));
}

TEST(PoseFile, CutOffAnywhereIsAnError) {
  const std::string text = poseToJson(hipsAndHead());
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_NE(poseRefusal(text.substr(0, size)), "") << size;
  }
}

}  // namespace
}  // namespace limber
