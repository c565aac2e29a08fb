#include "limber/document/clip/moving_parents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/replace_clips.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"
#include "warning_kinds.h"

namespace limber {
namespace {

// The skeleton, a skinned mesh and a camera below an armature that goes 3 m along X in a second and lies turned.
Asset movingArmature() {
  testing::GltfBuilder model = testing::everythingModel();
  const Index times = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  const Index slots = model.accessor<float>({0, 1, 0, 3, 1, 0}, 5126, "VEC3", 2);
  model.push("nodes", {{"name", "prop"}, {"camera", 0}, {"translation", {0.0, 0.0, 2.0}}});
  model.push("nodes", {{"name", "armature"},
                       {"children", {0, 2, 4}},
                       {"rotation", {0.0, 0.70710678, 0.0, 0.70710678}},
                       {"scale", {0.5, 0.5, 0.5}}});
  model.json["scenes"][0]["nodes"] = {5};
  Json& animation = model.json["animations"][0];
  animation["samplers"].push_back({{"input", times}, {"output", slots}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 5}, {"path", "translation"}}}});
  return readAsset(model.glb(), "armature.glb");
}

// Where one node is at a moment of the first animation, as a skeleton of that node alone reads it.
Vec3 positionAt(const Asset& asset, Index node, double seconds) {
  AssetSkeleton alone;
  alone.skeleton.joints.emplace_back().name = "alone";
  alone.jointNode = {node};
  Warnings ignored;
  Pose pose = restPose(alone.skeleton);
  sampleClip(readClips(asset, alone, ignored).at(0), seconds, pose);
  return pose.locals[0].translation;
}

std::vector<std::string> channelsOf(const Asset& asset) {
  std::vector<std::string> targets;
  for (const gltf::AnimationChannel& channel : asset.document.animations.at(0).channels) {
    targets.push_back(asset.document.nodes[*channel.target.node].name + " " + channel.target.path);
  }
  return targets;
}

TEST(MovingParents, StandStillAndWhatHangsOnThemMoves) {
  Asset asset = movingArmature();
  const Asset before = asset.clone();
  settleMovingParents(asset, readSkeleton(asset));
  checkAsset(asset);
  EXPECT_THAT(channelsOf(asset), ::testing::Not(::testing::Contains(::testing::StartsWith("armature"))));
  EXPECT_THAT(channelsOf(asset), ::testing::Not(::testing::Contains(::testing::StartsWith("body"))));
  for (const Index node : {0u, 1u, 3u, 4u}) {
    for (const double seconds : {0.0, 0.4, 1.0}) {
      EXPECT_LT((positionAt(asset, node, seconds) - positionAt(before, node, seconds)).norm(), 1e-5) << node;
    }
  }
  EXPECT_NEAR((positionAt(asset, 4, 1) - positionAt(asset, 4, 0)).x(), 3, 1e-5);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "moving-parents");

  const Bytes settled = writeGlb(asset);
  settleMovingParents(asset, readSkeleton(asset));
  EXPECT_EQ(writeGlb(asset), settled) << "nothing is left to do";
}

TEST(MovingParents, ReplacedClipsMoveOnce) {
  Asset asset = movingArmature();
  const Asset before = asset.clone();
  const AssetSkeleton rig = readSkeleton(asset);
  Warnings warnings;
  replaceClips(asset, rig, readClips(asset, rig, warnings));
  for (const Index node : {0u, 1u, 4u}) {
    for (const double seconds : {0.0, 0.4, 1.0}) {
      EXPECT_LT((positionAt(asset, node, seconds) - positionAt(before, node, seconds)).norm(), 1e-5) << node;
    }
  }
}

// Exporters key every node: what repeats the node's own transform is no movement.
TEST(MovingParents, ATrackThatRepeatsTheNodesOwnTransformMovesNothing) {
  for (const double off : {0.0, 0.5}) {
    Asset asset = movingArmature();
    gltf::Animation& animation = asset.document.animations[0];
    gltf::Node& armature = asset.document.nodes[5];
    armature.translation = Vec3(1, 2, 3 - off);
    animation.samplers[1].interpolation = Interpolation::kLinear;
    animation.samplers[1].output = addFloatAccessor(asset, std::vector<float>{1, 2, 3, 1, 2, 3}, 3);
    const Asset before = asset.clone();
    const AssetSkeleton rig = readSkeleton(asset);
    Warnings warnings;
    const std::vector<Clip> clips = readClips(asset, rig, warnings);
    const bool isSampled = clips.at(0).translations.size() + clips[0].rotations.size() > 0 &&
                           testing::countOf(warnings, "moving-parents") > 0;
    EXPECT_EQ(isSampled, off > 0) << "constant, but elsewhere: a movement";
    settleMovingParents(asset, rig);
    EXPECT_EQ(testing::countOf(asset.warnings, "moving-parents") > 0, off > 0);
    if (off == 0) {
      EXPECT_EQ(writeGlb(asset), writeGlb(before));
    }
    for (const Index node : {0u, 4u}) {
      EXPECT_LT((positionAt(asset, node, 0.5) - positionAt(before, node, 0.5)).norm(), 1e-5) << node;
    }
  }
}

TEST(MovingParents, OtherAnimationsStayAsTheyAre) {
  Asset asset = movingArmature();
  const Bytes before = writeGlb(asset);
  settleMovingParents(asset, readSkeleton(asset), {});
  EXPECT_EQ(writeGlb(asset), before);
}

TEST(MovingParents, AMeshOnSuchANodeIsTold) {
  Asset asset = movingArmature();
  asset.document.nodes[5].mesh = 0;
  settleMovingParents(asset, readSkeleton(asset));
  std::vector<std::string> kinds;
  for (const Warning& warning : asset.warnings.items()) kinds.push_back(warning.kind);
  EXPECT_THAT(kinds, ::testing::UnorderedElementsAre("still-parents", "moving-parents"));
}

TEST(MovingParents, ACameraOrALightOnSuchANodeIsTold) {
  Asset camera = movingArmature();
  camera.document.nodes[5].camera = 0;
  settleMovingParents(camera, readSkeleton(camera));
  EXPECT_EQ(testing::countOf(camera.warnings, "still-parents"), 1u);
  Asset light = movingArmature();
  light.document.nodes[5].extensions = gltf::KeptJson(Json{{"KHR_lights_punctual", {{"light", 0}}}});
  settleMovingParents(light, readSkeleton(light));
  EXPECT_EQ(testing::countOf(light.warnings, "still-parents"), 1u);
}

TEST(MovingParents, LongClipsOfManyNodesAreRefusedBeforeTheyAreSampled) {
  Asset asset = movingArmature();
  const Index times = addFloatAccessor(asset, std::vector<float>{0, 15000}, 1);  // 900 000 samples
  asset.document.animations[0].samplers[1].input = times;
  for (int i = 0; i < 20; ++i) {
    gltf::Node prop;
    prop.camera = 0;
    const Index added = addElement(asset.document.nodes, std::move(prop));
    asset.document.nodes[5].children.push_back(added);
  }
  try {
    settleMovingParents(asset, readSkeleton(asset));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
  }
}

TEST(MovingParents, OnlyTheAnimationsAtHandAreRead) {
  Asset asset = movingArmature();
  gltf::Animation other = asset.document.animations[0];
  other.samplers[0].input = other.samplers[1].input = addFloatAccessor(asset, std::vector<float>{1, 0}, 1);
  asset.document.animations.push_back(std::move(other));
  const std::vector<Index> first = {0};
  settleMovingParents(asset, readSkeleton(asset), first);
  EXPECT_EQ(testing::warningKinds(asset.warnings), std::vector<std::string>{"moving-parents"});
}

}  // namespace
}  // namespace limber
