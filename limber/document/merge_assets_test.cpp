#include "limber/document/merge_assets.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/check_asset.h"
#include "limber/document/read.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

// A triangle with everything that has a number: texture, material variant, light, clip, camera, extensions.
Asset everything(const std::string& extensionOfAll) {
  testing::GltfBuilder builder;
  const Index position = builder.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
  builder.json["accessors"][position]["min"] = {0, 0, 0};
  builder.json["accessors"][position]["max"] = {1, 1, 0};
  const Index times = builder.accessor(std::vector<float>{0, 1}, 5126, "SCALAR", 2);
  const Index turns = builder.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1}, 5126, "VEC4", 2);
  Json& json = builder.json;
  json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_variants", "KHR_animation_pointer", extensionOfAll};
  json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}},
                        {"KHR_materials_variants", {{"variants", {{{"name", "red"}}}}}},
                        {extensionOfAll, {{"node", 0}}}};
  json["images"] = {{{"uri", "skin.png"}}};
  json["textures"] = {{{"source", 0}}};
  const Json sheen = {{"index", 0}, {"extensions", {{extensionOfAll, {{"within", true}}}}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"extensions", {{"KHR_materials_sheen", {{"sheenColorTexture", sheen}}}}}}};
  const Json variants = {{"KHR_materials_variants", {{"mappings", {{{"material", 0}, {"variants", {0}}}}}}}};
  json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"material", 0}, {"extensions", variants}}}}}};
  json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 1}}}}};
  json["nodes"] = {{{"name", "body"}, {"children", {1, 2}}},
                   {{"name", "hand"}, {"mesh", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                   {{"name", "eye"}, {"camera", 0}}};
  const Json pointed = {
      {"path", "pointer"},
      {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/2/extensions/KHR_node_visibility/visible"}}}}}};
  json["animations"] = {
      {{"name", "walk"},
       {"samplers", {{{"input", times}, {"output", turns}}}},
       {"channels",
        {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}, {{"sampler", 0}, {"target", pointed}}}}}};
  json["scenes"] = {{{"nodes", {0}}}};
  json["scene"] = 0;
  return readAsset(builder.glb(), "everything.glb",
                   [](std::string_view) -> std::optional<Bytes> { return Bytes{0x89, 'P', 'N', 'G', 13, 10, 26, 10}; });
}

Asset merged() {
  std::vector<AssetPart> parts;
  parts.push_back({everything("VRMC_vrm"), "first", Affine(Eigen::Translation3d(1, 0, 0)), std::nullopt});
  parts.push_back({everything("VRMC_vrm"), "body", Affine(Eigen::Translation3d(0, 2, 0)), AssetPart::Carrier{0, 1}});
  return mergeAssets(std::move(parts));
}

TEST(MergeAssets, RenumbersWhatTheSecondPartRefersTo) {
  const Asset asset = merged();
  checkAsset(asset);
  const Json json = testing::documentJson(asset);
  EXPECT_EQ(json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 1);
  EXPECT_EQ(json["materials"][1]["extensions"]["KHR_materials_sheen"]["sheenColorTexture"]["index"], 1);
  EXPECT_EQ(json["textures"][1]["source"], 1);
  const Json& part = json["meshes"][1]["primitives"][0];
  EXPECT_EQ(part["attributes"]["POSITION"], 3);
  EXPECT_EQ(part["extensions"]["KHR_materials_variants"]["mappings"][0]["variants"], Json({1}));
  EXPECT_EQ(json["extensions"]["KHR_lights_punctual"]["lights"].size(), 2u);
  // Three nodes of the first, the node over it, and then the second's.
  EXPECT_EQ(json["nodes"][5]["extensions"]["KHR_lights_punctual"]["light"], 1);
  EXPECT_EQ(json["nodes"][6]["camera"], 1);
  const Json& channels = json["animations"][1]["channels"];
  EXPECT_EQ(channels[0]["target"]["node"], 5);
  EXPECT_EQ(channels[1]["target"]["extensions"]["KHR_animation_pointer"]["pointer"],
            "/nodes/6/extensions/KHR_node_visibility/visible");
  EXPECT_EQ(json["animations"][1]["name"], "walk_2");
  EXPECT_EQ(json["extensionsUsed"].size(), 3u);
}

TEST(MergeAssets, PartsStandInTheirPlacesAndHangOnTheirCarriers) {
  const Asset asset = merged();
  const SceneGraph graph = readSceneGraph(asset.document);
  EXPECT_EQ(asset.document.nodes[3].name, "first");
  EXPECT_EQ(asset.document.nodes[7].name, "body");
  EXPECT_EQ(asset.document.nodes[0].name, "body_2");
  EXPECT_EQ(graph.parent[7], 1u);
  EXPECT_TRUE(graph.world[5].translation().isApprox(Vec3(1, 2, 0)));
  EXPECT_EQ(asset.document.scenes[0].nodes, std::vector<Index>{3});
}

TEST(MergeAssets, FilesOfOneNameStayTwo) {
  const Asset asset = merged();
  ASSERT_EQ(asset.sideFiles.size(), 2u);
  EXPECT_NE(asset.sideFiles[0].uri, asset.sideFiles[1].uri);
  EXPECT_EQ(asset.document.images[1].uri, asset.sideFiles[1].uri);
}

TEST(MergeAssets, WhatIsSaidOfAWholeModelIsLeftOutWithAWarning) {
  const Asset asset = merged();
  EXPECT_EQ(testing::documentJson(asset).dump().find("VRMC_vrm"), std::string::npos);
  std::size_t warned = 0;
  for (const Warning& warning : asset.warnings.items()) warned += warning.kind == "scene-extensions";
  EXPECT_EQ(warned, 1u);
}

}  // namespace
}  // namespace limber
