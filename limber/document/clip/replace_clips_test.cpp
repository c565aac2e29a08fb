#include "limber/document/clip/replace_clips.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"

namespace limber {
namespace {

// The clip "turn" of a joint gets the weights of a shape, too, and "wink" moves those alone.
Asset withWeights() {
  testing::GltfBuilder model = testing::everythingModel();
  const Index times = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  const Index weights = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  const Json sampler = {{"input", times}, {"output", weights}};
  const Json target = {{"node", 2}, {"path", "weights"}};
  model.json["animations"][0]["samplers"].push_back(sampler);
  model.json["animations"][0]["channels"].push_back({{"sampler", 1}, {"target", target}});
  model.push("animations", {{"name", "wink"},
                            {"samplers", Json::array({sampler})},
                            {"channels", Json::array({{{"sampler", 0}, {"target", target}}})}});
  return readAsset(model.glb(), "weights.glb");
}

TEST(ReplaceClips, WeightsStayInTheClipOfTheirName) {
  Asset asset = withWeights();
  const AssetSkeleton rig = readSkeleton(asset);
  Warnings warnings;
  const std::vector<Clip> clips = readClips(asset, rig, warnings);
  ASSERT_EQ(clips.size(), 2u);
  replaceClips(asset, rig, std::span(clips).first(1));
  checkAsset(asset);
  ASSERT_EQ(asset.document.animations.size(), 2u);
  EXPECT_EQ(asset.document.animations[0].name, "wink");
  const gltf::Animation& turn = asset.document.animations[1];
  EXPECT_EQ(turn.name, "turn");
  ASSERT_EQ(turn.channels.size(), 2u);
  EXPECT_EQ(turn.channels[0].target.path, "rotation");
  EXPECT_EQ(turn.channels[1].target.path, "weights");
  EXPECT_EQ(turn.channels[1].sampler, 1u);
}

TEST(ReplaceClips, AModelWithoutJointsKeepsItsWeights) {
  Asset asset = withWeights();
  asset.document.animations.erase(asset.document.animations.begin());  // "turn"
  const std::vector<Clip> clips = readClips(asset, {}, asset.warnings);
  replaceClips(asset, {}, clips, TimeSpan{0, 0.5});
  checkAsset(asset);
  ASSERT_EQ(asset.document.animations.size(), 1u);
  ASSERT_EQ(asset.document.animations[0].channels.size(), 1u);
  EXPECT_EQ(asset.document.animations[0].name, "wink");
  EXPECT_THAT(readFloats(asset, asset.document.animations[0].samplers[0].input), ::testing::ElementsAre(0, 0.5f));
}

TEST(ReplaceClips, WeightsAreCutAsTheClipsWere) {
  Asset asset = withWeights();
  const AssetSkeleton rig = readSkeleton(asset);
  const std::vector<Clip> clips = readClips(asset, rig, asset.warnings);
  replaceClips(asset, rig, std::span(clips).first(1), TimeSpan{0.25, 0.5});
  checkAsset(asset);
  const gltf::Animation& turn = asset.document.animations[1];
  EXPECT_THAT(readFloats(asset, turn.samplers[1].input), ::testing::ElementsAre(0, 0.25f));
  EXPECT_THAT(readFloats(asset, turn.samplers[1].output), ::testing::ElementsAre(0.25f, 0.5f));
  const gltf::Animation& wink = asset.document.animations[0];
  EXPECT_THAT(readFloats(asset, wink.samplers[0].input), ::testing::ElementsAre(0, 1)) << "is none of the clips";
}

}  // namespace
}  // namespace limber
