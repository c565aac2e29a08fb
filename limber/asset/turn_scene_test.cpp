#include "limber/asset/turn_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/asset/scene_graph.h"

namespace limber {
namespace {

const Quat kTurn(0.5, 0.5, 0.5, -0.5);

Asset nodesOf(Json nodes) {
  Asset asset;
  asset.json()["asset"] = {{"version", "2.0"}};
  asset.json()["nodes"] = std::move(nodes);
  return asset;
}

void expectTurned(const SceneGraph& before, const SceneGraph& after, Index node) {
  EXPECT_TRUE(after.world[node].isApprox(kTurn * before.world[node], 1e-6)) << node;
}

TEST(TurnScene, TakesAllAlongButWhatJointsPlace) {
  Asset asset = nodesOf({{{"name", "a"}, {"children", {1}}, {"translation", {1, 2, 3}}},
                         {{"name", "b"}, {"scale", {2, 2, 2}}},
                         {{"name", "top"}},
                         {{"name", "skinned"}, {"mesh", 0}, {"skin", 0}}});
  asset.json()["scenes"] = {{{"nodes", {0, 2, 3}}}, {{"nodes", {2}}}, {{"nodes", Json::array()}}};
  const SceneGraph before = readSceneGraph(asset);
  turnScene(asset, kTurn, "top");
  const SceneGraph after = readSceneGraph(asset);
  ASSERT_EQ(after.nodeCount(), 5u) << "both scenes share one";
  for (const Index node : {0u, 1u, 2u}) expectTurned(before, after, node);
  EXPECT_TRUE(after.world[3].isApprox(before.world[3]));
  EXPECT_TRUE(after.shown[3]);
  EXPECT_EQ(asset.json()["nodes"][4]["name"], "top_2");
  EXPECT_EQ(asset.json()["scenes"][1]["nodes"], Json({4}));
}

TEST(TurnScene, ADocumentWithoutScenesGetsOne) {
  Asset asset = nodesOf({{{"name", "a"}}, {{"name", "b"}}});
  const SceneGraph before = readSceneGraph(asset);
  turnScene(asset, kTurn, "turned");
  for (const Index node : {0u, 1u}) expectTurned(before, readSceneGraph(asset), node);
}

}  // namespace
}  // namespace limber
