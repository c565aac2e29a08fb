// Transforms of mirrored nodes, and what refers to nodes that go: springs. The rest is tested with rigs and joints.
#include "limber/document/scene/node_edit.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {
namespace {

Asset withSprings(const Json& extension) {
  Asset asset;
  asset.document.extensionsUsed = {"VRMC_springBone"};
  for (int n = 0; n < 5; ++n) asset.document.nodes.emplace_back().name = std::to_string(n);
  changeExtension(asset.document, kSpringBoneName) = extension;
  return asset;
}

const Json kTwoSprings = Json::parse(R"({
  "specVersion": "1.0",
  "springs": [{"name": "gone", "joints": [{"node": 1}, {"node": 2}]},
              {"name": "kept", "joints": [{"node": 3, "stiffness": 1}, {"node": 4}], "center": 2}]})");

TEST(SetNodeTransform, WhatIsMirroredStaysMirroredOnItsAxes) {
  gltf::Node node;
  node.scale = Vec3(1, 2, -1);
  Transform wanted{{1, 2, 3}, Quat(0.5, 0.5, -0.5, 0.5), {3, 1, -2}};
  setNodeTransform(node, wanted.toAffine(), false);
  EXPECT_TRUE(node.scale->isApprox(wanted.scale, 1e-6));
  EXPECT_TRUE(nodeTransform(node).isApprox(wanted.toAffine(), 1e-6));
  wanted.scale = {3, 1, 2};  // not mirrored any more
  setNodeTransform(node, wanted.toAffine(), false);
  EXPECT_TRUE(nodeTransform(node).isApprox(wanted.toAffine(), 1e-6));
}

TEST(DeleteNodes, SpringsOfTheirsGoAndOthersAreRenumbered) {
  Asset asset = withSprings(kTwoSprings);
  deleteNodes(asset, {true, false, false, true, true});
  const Json& springs = extensionOf(asset.document, kSpringBoneName)->at("springs");
  EXPECT_EQ(springs, Json::parse(R"([{"name": "kept", "joints": [{"node": 1, "stiffness": 1}, {"node": 2}]}])"));
  EXPECT_TRUE(asset.warnings.items().empty());
}

TEST(DeleteNodes, WithTheLastSpringTheExtensionGoes) {
  Asset asset = withSprings(kTwoSprings);
  deleteNodes(asset, {true, false, false, false, true});
  EXPECT_FALSE(asset.document.extensions.exists());
  EXPECT_TRUE(asset.document.extensionsUsed.empty());
}

TEST(DeleteNodes, CollidersOnDeletedNodesAreTold) {
  Json extension = kTwoSprings;
  extension["colliders"] = Json::parse(R"([{"node": 4}, {"node": 1}])");
  Asset asset = withSprings(extension);
  deleteNodes(asset, {true, false, true, true, true});
  EXPECT_EQ(extensionOf(asset.document, kSpringBoneName)->at("colliders")[0]["node"], 3);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "node-references");
}

TEST(DeleteNodes, BrokenSpringsDoNoHarm) {
  for (const char* broken : {R"({"springs": 3})", R"({"springs": [1, {"joints": 2}, {"joints": [7]}]})", "{}", "[]",
                             R"({"springs": [{"joints": [{"node": 99}]}], "colliders": {}})"}) {
    Asset asset = withSprings(Json::parse(broken));
    EXPECT_NO_THROW(deleteNodes(asset, {true, false, true, true, true})) << broken;
  }
}

}  // namespace
}  // namespace limber
