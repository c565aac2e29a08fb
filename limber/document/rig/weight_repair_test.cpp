#include "limber/document/rig/weight_repair.h"

#include <array>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/read.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using testing::SceneBuilder;

// A skinned tetrahedron, each vertex with these weights of two joints.
Asset weighted(const std::vector<std::array<float, 2>>& rows) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index tip = scene.addNode({{"name", "tip"}, {"translation", {0, 1, 0}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}});
  const Index skin = scene.addSkin({root, tip}, {});
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  for (const std::array<float, 2>& row : rows) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {row[0], row[1], 0, 0});
  }
  scene.bind(mesh, joints, weights);
  const Index body = scene.addNode({{"mesh", mesh}, {"skin", skin}});
  scene.addScene({root, body});
  return scene.build();
}

std::vector<float> weightsOf(const Asset& asset) {
  return readFloats(asset, *asset.document.meshes[0].primitives[0].attributes.find("WEIGHTS_0"));
}

TEST(RepairWeights, WhatIsNoWeightIsZeroAndTold) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  const Bytes file = writeGlb(weighted({{nan, 1}, {-1, 0.5f}, {infinite, 0}, {0.5f, 0.5f}}));
  const Asset asset = readAsset(file, "bad.glb");
  EXPECT_THAT(weightsOf(asset), ::testing::ElementsAre(0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0.5f, 0.5f, 0, 0));
  ASSERT_EQ(asset.warnings.items().size(), 2u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "bad-weights");
  EXPECT_EQ(asset.warnings.items()[0].count, 3u);
  EXPECT_EQ(asset.warnings.items()[1].kind, "unweighted-vertices");
  EXPECT_EQ(asset.warnings.items()[1].count, 1u);
  // What is written is clean.
  EXPECT_EQ(weightsOf(readAsset(writeGlb(asset), "clean.glb")), weightsOf(asset));
}

TEST(RepairWeights, VerticesWithoutSetsOfWeightsAreTold) {
  Asset asset = weighted({{1, 0}, {0, 1}, {0.5f, 0.5f}, {0.25f, 0.75f}});
  asset.document.meshes[0].primitives[0].attributes.erase("JOINTS_0");
  asset.document.meshes[0].primitives[0].attributes.erase("WEIGHTS_0");
  const Asset read = readAsset(writeGlb(asset), "none.glb");
  ASSERT_EQ(read.warnings.items().size(), 1u);
  EXPECT_EQ(read.warnings.items()[0].kind, "unweighted-vertices");
  EXPECT_EQ(read.warnings.items()[0].count, 4u);
}

TEST(RepairWeights, GoodFilesKeepTheirBytes) {
  const Bytes file = writeGlb(weighted({{1, 0}, {0, 1}, {0.5f, 0.5f}, {0.25f, 0.75f}}));
  const Asset asset = readAsset(file, "good.glb");
  EXPECT_TRUE(asset.warnings.empty());
  EXPECT_EQ(writeGlb(asset), file);
}

}  // namespace
}  // namespace limber
