// readSkeleton and readWeights.
#include <gtest/gtest.h>

#include "limber/document/testing/attached_rig.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

using testing::attach;
using testing::Attached;
using testing::SceneBuilder;
using testing::threeJoints;
using testing::translation;

TEST(ReadSkeleton, IsWhatWasAttached) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}, {"scale", {3, 3, 3}}});
  const Attached rigged = attach(scene.build());
  const AssetSkeleton read = readSkeleton(rigged.after);
  const Skeleton made = threeJoints();
  ASSERT_EQ(read.skeleton.jointCount(), 3u);
  EXPECT_EQ(read.skeleton.boneShape, BoneShape::kSphere);
  for (Index j = 0; j < 3; ++j) {
    EXPECT_EQ(read.skeleton.joints[j].name, made.joints[j].name);
    EXPECT_EQ(read.skeleton.joints[j].parent, made.joints[j].parent);
    EXPECT_NEAR(read.skeleton.joints[j].radius, made.joints[j].radius, 1e-7);
    EXPECT_LT((read.skeleton.joints[j].rest.translation - made.joints[j].rest.translation).norm(), 1e-6);
  }
  checkSkeleton(read.skeleton);
  const SkinWeights weights = readWeights(rigged.after, collectGeometry(rigged.after), read);
  ASSERT_EQ(weights.slots, 4u);
  EXPECT_EQ(weights.joints, rigged.weights.joints);
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    EXPECT_NEAR(weights.weights[i], rigged.weights.weights[i], 1e-6);
  }
}

TEST(ReadSkeleton, NodesBetweenJointsBelongToItAndNamesAreUnique) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index hand = scene.addNode({{"name", "bone"}, {"translation", {0, 0, 1}}});
  const Index helper = scene.addNode({{"children", {hand}}, {"translation", {0, 1, 0}}});
  const Index aside = scene.addNode({{"name", "end"}});
  const Index hip = scene.addNode({{"name", "bone"}, {"children", {helper, aside}}, {"translation", {1, 0, 0}}});
  scene.addNode({{"name", "armature"}, {"children", {hip}}});
  scene.bindRigidly(mesh, {0, 0, 0, 1});
  const Index skin = scene.addSkin({hand, hip}, {translation(-1, -1, -1), translation(-1, 0, 0)});
  scene.addNode({{"mesh", mesh}, {"skin", skin}});
  const Asset asset = scene.build();
  const AssetSkeleton read = readSkeleton(asset);
  checkSkeleton(read.skeleton);
  EXPECT_EQ(read.jointNode, (std::vector<Index>{hip, helper, hand}));
  EXPECT_EQ(read.skeleton.joints[2].name, "bone_2");
  EXPECT_EQ(read.skeleton.boneShape, BoneShape::kSegment);
  EXPECT_TRUE(restGlobals(read.skeleton)[2].translation().isApprox(Vec3(1, 1, 1), 1e-6));
  const SkinWeights weights = readWeights(asset, collectGeometry(asset), read);
  EXPECT_EQ(weights.jointsOf(0)[0], 2u);  // joint 0 of the skin is the hand
  EXPECT_EQ(weights.jointsOf(3)[0], 0u);
}

TEST(ReadSkeleton, TakesTheBindPoseOfAPosedFile) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index tip = scene.addNode({{"name", "tip"}, {"translation", {9, 9, 9}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}});
  scene.bindRigidly(mesh, {0, 0, 0, 1});
  const Index skin = scene.addSkin({root, tip}, {translation(0, 0, 0), translation(0, -2, 0)});
  scene.addNode({{"mesh", mesh}, {"skin", skin}});
  const AssetSkeleton read = readSkeleton(scene.build());
  EXPECT_TRUE(read.skeleton.joints[1].rest.translation.isApprox(Vec3(0, 2, 0), 1e-6));
}

TEST(ReadSkeleton, AFileOfJointsAloneHasOne) {
  SceneBuilder scene;
  const Index tip = scene.addNode({{"name", "tip"}, {"translation", {0, 1, 0}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}});
  scene.addSkin({root, tip}, {translation(0, 0, 0), translation(0, -1, 0)});
  const Asset asset = scene.build();
  EXPECT_FALSE(hasRig(asset));
  EXPECT_EQ(readSkeleton(asset).skeleton.jointCount(), 2u);
}

TEST(ReadWeights, SaysWhatTheFileSays) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index hat = scene.addTetrahedron();
  const Index loose = scene.addTetrahedron();
  const Index hatNode = scene.addNode({{"mesh", hat}});
  const Index tip = scene.addNode({{"name", "tip"}, {"children", {hatNode}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}});
  const Index skin = scene.addSkin({root, tip}, {});
  const std::vector<std::uint8_t> joints = {0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
  const std::vector<float> weights = {0.25f, 0.5f, 0.25f, 0, 0, 0, 0, 0, -1, 0.5f, 0, 0, 3, 0, 0, 0};
  scene.bind(mesh, joints, weights);
  scene.addNode({{"mesh", mesh}, {"skin", skin}});
  scene.addNode({{"mesh", loose}});
  const Asset& asset = scene.asset();
  const Geometry geometry = collectGeometry(asset);
  const SkinWeights read = readWeights(asset, geometry, readSkeleton(asset));
  for (const PrimitiveInstance& instance : geometry.instances) {
    const Index v = instance.firstVertex;
    if (instance.node == hatNode) {
      EXPECT_EQ(read.jointsOf(v)[0], 1u);
      EXPECT_EQ(read.weightsOf(v)[0], 1);
    } else if (instance.mesh == loose) {
      EXPECT_EQ(read.weightsOf(v)[0], 0);
    } else {
      EXPECT_EQ(read.jointsOf(v)[0], 1u);  // named twice: added up, strongest first
      EXPECT_EQ(read.weightsOf(v)[0], 0.75f);
      EXPECT_EQ(read.weightsOf(v)[1], 0.25f);
      EXPECT_EQ(read.weightsOf(v + 1)[0], 0);
      EXPECT_EQ(read.weightsOf(v + 2)[0], 0.5f);  // a negative weight counts as none
      EXPECT_EQ(read.weightsOf(v + 2)[1], 0);
      EXPECT_EQ(read.weightsOf(v + 3)[0], 3);  // as the file has them
    }
  }
}

}  // namespace
}  // namespace limber
