#include "limber/evaluate/skin/skinned_model.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/asset.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/testing/two_bind_poses.h"

namespace limber {
namespace {

TEST(ReadSkinnedModel, BringsSkinsToOneBindPose) {
  const std::vector<Vec3f> wanted = readSkinnedModel(testing::partsInTwoBindPoses(Vec3f::Zero())).mesh.positions;
  const std::vector<Vec3f> found = readSkinnedModel(testing::partsInTwoBindPoses({0, 5, 0})).mesh.positions;
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t v = 0; v < wanted.size(); ++v) EXPECT_LT((found[v] - wanted[v]).norm(), 1e-5f) << v;
}

TEST(ReadSkinnedModel, HasTheShapesThatAreInUse) {
  Asset asset = testing::partsInTwoBindPoses(Vec3f::Zero());
  const std::vector<Vec3f> before = readSkinnedModel(asset).mesh.positions;
  const std::vector<float> offsets = {0, 3, 0, 0, 3, 0, 0, 3, 0, 0, 3, 0};
  asset.document.meshes[0].primitives[0].targets.emplace_back().set(
      "POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
  asset.document.meshes[0].weights = {0.5};
  const std::vector<Vec3f> after = readSkinnedModel(asset).mesh.positions;
  EXPECT_EQ(after[1], before[1] + Vec3f(0, 1.5f, 0));
  EXPECT_EQ(after[5], before[5]);
}

// Two rows of squares that meet at a seam, where the second one's grid has moved its vertices by `off`.
SkinnedModel seamed(float off) {
  SkinnedModel model;
  for (int part = 0; part < 2; ++part) {
    for (int i = 0; i < 10; ++i) {
      const float y = static_cast<float>(i / 2), x = static_cast<float>(part + i % 2);
      model.mesh.positions.push_back({part == 1 ? x + off : x, y, 0});
      model.weights.joints.push_back(static_cast<Index>(part));
      model.weights.weights.push_back(1);
    }
    const Index first = static_cast<Index>(10 * part);
    for (Index i = 0; i < 8; i += 2) {
      model.mesh.triangles.push_back({first + i, first + i + 1, first + i + 3});
      model.mesh.triangles.push_back({first + i, first + i + 3, first + i + 2});
    }
    model.stored.push_back({first, 10, Vec3::Zero(), 0.02});
  }
  model.weights.slots = 1;
  model.skeleton.joints = {{"a", std::nullopt, {}, 0}, {"b", 0, {}, 0}};
  return model;
}

TEST(WeldedModel, ClosesSeamsOfGrids) {
  SkinnedModel model = seamed(0.01f);
  EXPECT_EQ(weldedModel(model).mesh.vertexCount(), 15u);
  model.stored.clear();
  EXPECT_EQ(weldedModel(model).mesh.vertexCount(), 20u);
}

TEST(WeldedModel, AVertexIsTheLowestAtItsPlace) {
  const SkinnedModel model = seamed(0.01f), welded = weldedModel(model);
  ASSERT_EQ(welded.mesh.vertexCount(), 15u);
  for (Index v = 0; v < 10; ++v) {
    EXPECT_EQ(welded.mesh.positions[v], model.mesh.positions[v]) << v;
    EXPECT_EQ(welded.weights.jointsOf(v)[0], 0u) << v;
  }
}

}  // namespace
}  // namespace limber
