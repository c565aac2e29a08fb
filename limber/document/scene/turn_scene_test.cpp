#include "limber/document/scene/turn_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/gltf_json.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {
namespace {

const Quat kTurn(0.5, 0.5, 0.5, -0.5);

Asset assetOf(Json nodes, Json scenes) {
  Json json = {{"asset", {{"version", "2.0"}}}, {"nodes", std::move(nodes)}, {"scenes", std::move(scenes)}};
  Asset asset;
  asset.document = gltf::documentOf(std::move(json));
  return asset;
}

void expectTurned(const SceneGraph& before, const SceneGraph& after, Index node) {
  EXPECT_TRUE(after.world[node].isApprox(kTurn * before.world[node], 1e-6)) << node;
}

TEST(TurnScene, TakesAllAlongButWhatJointsPlace) {
  Asset asset = assetOf({{{"name", "a"}, {"children", {1}}, {"translation", {1, 2, 3}}},
                         {{"name", "b"}, {"scale", {2, 2, 2}}},
                         {{"name", "top"}},
                         {{"name", "skinned"}, {"mesh", 0}, {"skin", 0}}},
                        {{{"nodes", {0, 2, 3}}}, {{"nodes", {2}}}, {{"nodes", Json::array()}}});
  const SceneGraph before = readSceneGraph(asset.document);
  turnScene(asset, kTurn, "top");
  const SceneGraph after = readSceneGraph(asset.document);
  ASSERT_EQ(after.nodeCount(), 5u) << "both scenes share one";
  for (const Index node : {0u, 1u, 2u}) expectTurned(before, after, node);
  EXPECT_TRUE(after.world[3].isApprox(before.world[3]));
  EXPECT_TRUE(after.shown[3]);
  EXPECT_EQ(asset.document.nodes[4].name, "top_2");
  EXPECT_EQ(asset.document.scenes[1].nodes, std::vector<Index>{4});
}

TEST(TurnScene, ADocumentWithoutScenesGetsOne) {
  Asset asset = assetOf({{{"name", "a"}}, {{"name", "b"}}}, Json::array());
  const SceneGraph before = readSceneGraph(asset.document);
  turnScene(asset, kTurn, "turned");
  for (const Index node : {0u, 1u}) expectTurned(before, readSceneGraph(asset.document), node);
}

}  // namespace
}  // namespace limber
