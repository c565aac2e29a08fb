#include "limber/evaluate/asset_info.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/testing/two_bind_poses.h"
#include "warning_kinds.h"

namespace limber {
namespace {

// Two tetrahedra's worth of triangles: one closed, one with a face missing, each with vertices of its own.
Asset twoTetrahedra() {
  Asset asset;
  std::vector<float> positions;
  std::vector<std::uint16_t> indices;
  for (int i = 0; i < 2; ++i) {
    const float x = 5.0f * float(i);
    for (const float v : {x, 0.f, 0.f, x + 1, 0.f, 0.f, x, 1.f, 0.f, x, 0.f, 1.f}) positions.push_back(v);
    const int base = 4 * i;
    for (const int v : {0, 2, 1, 0, 1, 3, 1, 2, 3}) indices.push_back(std::uint16_t(base + v));
  }
  for (const int v : {0, 3, 2}) indices.push_back(std::uint16_t(v));
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.indices =
      addAccessor(asset, {Index(indices.size()), 1, ComponentType::kU16, false},
                  {reinterpret_cast<const std::uint8_t*>(indices.data()), indices.size() * 2}, kIndexTarget);
  gltf::Document& document = asset.document;
  document.meshes.emplace_back().primitives.push_back(std::move(primitive));
  document.nodes.emplace_back().mesh = 0;
  document.scenes.emplace_back().nodes = {0};
  document.scene = 0;
  asset.format = "glb";
  return asset;
}

// Weights for the eight vertices over two joints: the last vertex has none, the one before sums to 0.75.
void addSkin(Asset& asset) {
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  for (int v = 0; v < 8; ++v) {
    for (const int j : {0, 1, 0, 0}) joints.push_back(std::uint8_t(j));
    const bool split = v == 2;
    for (const float w : {v == 7 ? 0.f : v == 6 ? 0.75f : split ? 0.9f : 1.f, split ? 0.1f : 0.f, 0.f, 0.f}) {
      weights.push_back(w);
    }
  }
  gltf::Document& document = asset.document;
  gltf::Attributes& attributes = document.meshes[0].primitives[0].attributes;
  attributes.set("JOINTS_0", addAccessor(asset, {8, 4, ComponentType::kU8, false}, joints, kVertexTarget));
  attributes.set("WEIGHTS_0", addFloatAccessor(asset, weights, 4, kVertexTarget));
  document.nodes[0].skin = 0;
  gltf::Node& hip = document.nodes.emplace_back();
  hip.name = "hip";
  hip.children = {2};
  document.nodes.emplace_back().name = "knee";
  document.scenes[0].nodes = {0, 1};
  document.skins.emplace_back().joints = {1, 2};
}

TEST(InspectAsset, CountsAMesh) {
  const AssetInfo info = inspectAsset(twoTetrahedra());
  EXPECT_EQ(info.format, "glb");
  EXPECT_EQ(info.storedVertices, 8u);
  EXPECT_EQ(info.sceneVertices, 8u);
  ASSERT_TRUE(info.surface);
  EXPECT_EQ(info.surface->triangles, 7u);
  EXPECT_EQ(info.surface->pieces, 2u);
  EXPECT_EQ(info.surface->openEdges, 3u);
  EXPECT_EQ(info.surface->crowdedEdges, 0u);
  EXPECT_FALSE(info.surface->watertight());
  EXPECT_EQ(info.bounds.min, Vec3(0, 0, 0));
  EXPECT_EQ(info.bounds.max, Vec3(6, 1, 1));
  EXPECT_FALSE(info.weights);
  EXPECT_TRUE(info.joints.empty());
}

TEST(InspectAsset, AnInstancedMeshIsStoredOnceAndShownTwice) {
  Asset asset = twoTetrahedra();
  gltf::Node& second = asset.document.nodes.emplace_back();
  second.mesh = 0;
  second.translation = Vec3(0, 3, 0);
  asset.document.scenes[0].nodes.push_back(1);
  const AssetInfo info = inspectAsset(asset);
  EXPECT_EQ(info.storedVertices, 8u);
  EXPECT_EQ(info.sceneVertices, 16u);
  EXPECT_EQ(info.surface->pieces, 4u);
  EXPECT_EQ(info.bounds.max, Vec3(6, 4, 1));
}

TEST(InspectAsset, ReadsWeightsAsStored) {
  Asset asset = twoTetrahedra();
  addSkin(asset);
  const AssetInfo info = inspectAsset(asset);
  EXPECT_THAT(info.joints, ::testing::ElementsAre("hip", "knee"));
  ASSERT_TRUE(info.weights);
  EXPECT_EQ(info.weights->vertices, 7u);
  EXPECT_EQ(info.weights->withoutWeights, 1u);
  EXPECT_FLOAT_EQ(info.weights->least, 0.1f);
  EXPECT_FLOAT_EQ(info.weights->greatest, 1.0f);
  EXPECT_NEAR(info.weights->largestSumError, 0.25, 1e-9);
  EXPECT_EQ(info.weights->maxInfluences, 2u);
}

// A person of VRM's names as a motion file has it: a skeleton without a mesh.
TEST(InspectAsset, MeasuresASkeletonInItsRestPose) {
  for (const double factor : {1.0, 0.01}) {
    Motion motion;
    motion.skeleton = testing::vrmPerson();
    for (Joint& joint : motion.skeleton.joints) joint.rest.translation *= factor;
    const AssetInfo info = inspectAsset(motionAsset(motion));
    ASSERT_TRUE(info.bodySize);
    EXPECT_NEAR(info.bodySize->height, 1.495 * factor, 1e-6);  // from the toes to the head
    EXPECT_NEAR(info.bodySize->hips.value(), 0.925 * factor, 1e-6);
    ASSERT_EQ(info.jointPositions.size(), info.joints.size());
    const auto hand = std::find(info.joints.begin(), info.joints.end(), "leftHand") - info.joints.begin();
    EXPECT_LT((info.jointPositions.at(static_cast<std::size_t>(hand)) - factor * Vec3(0.68, 1.4, 0)).norm(), 1e-6);
    EXPECT_EQ(testing::countOf(info.warnings, "unlikely-size"), factor == 1 ? 0u : 1u);
  }
}

TEST(InspectAsset, ReadsClips) {
  Asset asset = twoTetrahedra();
  gltf::Animation& hop = asset.document.animations.emplace_back();
  hop.name = "hop";
  gltf::AnimationSampler& sampler = hop.samplers.emplace_back();
  sampler.input = addFloatAccessor(asset, std::vector<float>{0, 1.5f, 2.25f}, 1, 0, true);
  sampler.output = addFloatAccessor(asset, std::vector<float>(9, 0.f), 3);
  gltf::AnimationChannel::Target& target = hop.channels.emplace_back().target;
  target.node = 0;
  target.path = "translation";
  const AssetInfo info = inspectAsset(asset);
  ASSERT_EQ(info.clips.size(), 1u);
  EXPECT_EQ(info.clips[0].name, "hop");
  EXPECT_DOUBLE_EQ(info.clips[0].seconds, 2.25);
  EXPECT_EQ(info.clips[0].channels, 1u);
}

TEST(InspectAsset, AFileWithoutATriangleIsToldAsSuch) {
  Asset asset;
  asset.document.nodes.emplace_back().name = "alone";
  const AssetInfo info = inspectAsset(asset);
  EXPECT_FALSE(info.surface);
  EXPECT_TRUE(info.bounds.empty());
  EXPECT_EQ(info.nodes, 1u);
}

TEST(InspectAsset, BoundsAreThoseOfOneBindPose) {
  const Box wanted = inspectAsset(testing::partsInTwoBindPoses(Vec3f::Zero())).bounds;
  EXPECT_EQ(wanted.min, Vec3(0, 0, 0));
  EXPECT_EQ(wanted.max, Vec3(3, 1, 1));
  const Asset elsewhere = testing::partsInTwoBindPoses({0, 5, 0}),
              unbound = testing::partsInTwoBindPoses({0, 0, -3}, false);
  ASSERT_FALSE(unbound.document.skins[1].inverseBindMatrices);
  for (const Asset* asset : {&elsewhere, &unbound}) {
    const AssetInfo info = inspectAsset(*asset);
    EXPECT_LT((info.bounds.min - wanted.min).norm(), 1e-5);
    EXPECT_LT((info.bounds.max - wanted.max).norm(), 1e-5);
    ASSERT_TRUE(info.weights);
    EXPECT_EQ(info.weights->withoutWeights, 0u);
  }
}

}  // namespace
}  // namespace limber
