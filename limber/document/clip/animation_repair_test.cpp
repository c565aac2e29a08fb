#include "limber/document/clip/animation_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

Json pointerAt(const char* pointer) {
  return {{"path", "pointer"}, {"extensions", {{kPointerName, {{"pointer", pointer}}}}}};
}

TEST(AnimationRepair, PointersAtNodesAreChannelsOfThem) {
  testing::GltfBuilder model = testing::everythingModel();
  model.json["extensionsUsed"] = {kPointerName};
  model.json["animations"][0]["channels"][0]["target"] = pointerAt("/nodes/1/rotation");
  const Asset asset = readAsset(model.glb(), "pointers.glb");
  const gltf::AnimationChannel& channel = asset.document.animations.at(0).channels.at(0);
  EXPECT_EQ(channel.target.node, 1u);
  EXPECT_EQ(channel.target.path, "rotation");
  EXPECT_FALSE(channel.target.extensions.exists());
  EXPECT_THAT(asset.document.extensionsUsed, ElementsAre());
  Warnings warnings;
  const std::vector<Clip> clips = readClips(asset, readSkeleton(asset), warnings);
  ASSERT_EQ(clips.at(0).rotations.size(), 1u);
  EXPECT_EQ(clips[0].rotations[0].times.size(), 2u);
}

TEST(AnimationRepair, OtherPointersStay) {
  for (const char* pointer : {"/materials/0/pbrMetallicRoughness/baseColorFactor", "/nodes/1/extensions/X/visible"}) {
    testing::GltfBuilder model = testing::everythingModel();
    model.json["extensionsUsed"] = {kPointerName};
    model.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", pointerAt(pointer)}});
    const Asset asset = readAsset(model.glb(), "pointers.glb");
    EXPECT_TRUE(asset.document.animations.at(0).channels.at(1).target.extensions.exists()) << pointer;
    EXPECT_THAT(asset.document.extensionsUsed, ElementsAre(kPointerName));
  }
  // Two channels of one target are against the format: the plain one is what readers without the extension play.
  testing::GltfBuilder twice = testing::everythingModel();
  twice.json["extensionsUsed"] = {kPointerName};
  twice.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", pointerAt("/nodes/1/rotation")}});
  const Asset asset = readAsset(twice.glb(), "pointers.glb");
  EXPECT_TRUE(asset.document.animations.at(0).channels.at(1).target.extensions.exists());

  testing::GltfBuilder missing = testing::everythingModel();
  missing.json["animations"][0]["channels"][0]["target"] = pointerAt("/nodes/99/rotation");
  missing.json["extensionsUsed"] = {kPointerName};
  Json both = missing.json["animations"][0];
  both["channels"].push_back({{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}});
  missing.push("animations", both);
  const Asset found = readAsset(missing.glb(), "pointers.glb");
  ASSERT_EQ(found.document.animations.size(), 1u) << "the first is empty";
  ASSERT_EQ(found.document.animations[0].channels.size(), 1u);
  EXPECT_EQ(found.document.animations[0].channels[0].target.node, 1u);
  EXPECT_THAT(found.document.extensionsUsed, ElementsAre());
  EXPECT_EQ(testing::countOf(found.warnings, "missing-targets"), 2u);
}

TEST(AnimationRepair, KeysBeforeZeroAreMovedWithAllOfTheirClip) {
  testing::GltfBuilder model = testing::everythingModel();
  const Index early = model.accessor<float>({-1, 0.5f}, 5126, "SCALAR", 2);
  const Index late = model.accessor<float>({0, 2}, 5126, "SCALAR", 2);
  const Index weights = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  Json& animation = model.json["animations"][0];
  Json other = animation;
  other["name"] = "other";
  animation["samplers"][0]["input"] = early;
  animation["samplers"].push_back({{"input", late}, {"output", weights}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 2}, {"path", "weights"}}}});
  model.push("animations", other);
  const Asset asset = readAsset(model.glb(), "early.glb");
  const std::vector<gltf::Animation>& animations = asset.document.animations;
  EXPECT_THAT(readFloats(asset, animations[0].samplers[0].input), ElementsAre(0, 1.5f));
  EXPECT_THAT(readFloats(asset, animations[0].samplers[1].input), ElementsAre(1, 3));
  EXPECT_THAT(readFloats(asset, animations[1].samplers[0].input), ElementsAre(0, 1));
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "negative-times");
}

}  // namespace
}  // namespace limber
