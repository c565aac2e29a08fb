#include "limber/preview/scene.h"

#include <gtest/gtest.h>

#include "limber/document/rig/pose_io.h"
#include "limber/preview/testing/rigged_stool.h"
#include "warning_kinds.h"

namespace limber {
namespace {

TEST(Scene, ShowsARiggedModelAsItsJointsStand) {
  Asset asset = testing::riggedStool();
  const Scene before = makeScene(asset);

  const AssetSkeleton rig = readSkeleton(asset);
  Pose pose = readNodePose(asset, rig);
  pose.locals[0].rotation = Quat(0, 0, 1, 0);  // half a turn about y
  writeNodePose(asset, rig, pose);
  const Scene after = makeScene(asset);

  const Vec3 pivot = before.joints[0].position;
  const auto turned = [&](const Vec3& p) { return Vec3(2 * pivot.x() - p.x(), p.y(), 2 * pivot.z() - p.z()); };
  ASSERT_EQ(after.positions.size(), before.positions.size());
  for (std::size_t v = 0; v < before.positions.size(); ++v) {
    EXPECT_LT((after.positions[v].cast<double>() - turned(before.positions[v].cast<double>())).norm(), 1e-5);
  }
  for (std::size_t j = 0; j < before.joints.size(); ++j) {
    EXPECT_LT((after.joints[j].position - turned(before.joints[j].position)).norm(), 1e-5);
  }
  EXPECT_EQ(after.weights.weights, before.weights.weights);
}

TEST(Scene, KnowsWhetherAPoseWasSaved) {
  Asset asset = testing::riggedStool();
  EXPECT_TRUE(SceneMaker(asset).isAtRest());
  const AssetSkeleton rig = readSkeleton(asset);
  const auto isAtRestWith = [&](const auto& change) {
    Asset posed = asset.clone();
    Pose pose = readNodePose(posed, rig);
    change(pose.locals.back());
    writeNodePose(posed, rig, pose);
    return SceneMaker(posed).isAtRest();
  };
  // A turn of the last joint moves no other one.
  EXPECT_FALSE(isAtRestWith([](Transform& local) { local.rotation = Quat(0, 0, 1, 0) * local.rotation; }));
  EXPECT_FALSE(isAtRestWith([](Transform& local) { local.translation.x() += 0.1; }));
  EXPECT_TRUE(isAtRestWith([](Transform& local) { local.translation.x() += 1e-6; }));
}

TEST(Scene, ReportsJointsBeyondEightOfAVertex) {
  Asset asset = testing::riggedStool();
  EXPECT_EQ(testing::countOf(makeScene(asset).warnings, "many-influences"), 0u);
  gltf::Attributes& attributes = asset.document.meshes.at(0).primitives.at(0).attributes;
  for (const char* set : {"_1", "_2"}) {
    attributes.set(std::string("JOINTS") + set, attributes.find("JOINTS_0").value());
    attributes.set(std::string("WEIGHTS") + set, attributes.find("WEIGHTS_0").value());
  }
  EXPECT_EQ(testing::countOf(makeScene(asset).warnings, "many-influences"), 1u);
}

}  // namespace
}  // namespace limber
