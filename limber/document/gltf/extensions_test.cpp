#include "limber/document/gltf/extensions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limber {
namespace {

gltf::Node nodeWith(const char* extensions) {
  gltf::Node node;
  node.extensions = gltf::KeptJson(Json::parse(extensions));
  return node;
}

TEST(Extensions, ErasingLeavesTheOthers) {
  gltf::Node node = nodeWith(R"({"A": {"x": 1}, "B": {}})");
  ASSERT_NE(extensionOf(node, "A"), nullptr);
  EXPECT_EQ(extensionOf(node, "A")->at("x"), 1);
  EXPECT_EQ(extensionOf(node, "C"), nullptr);
  EXPECT_FALSE(eraseExtension(node, "C"));
  EXPECT_TRUE(eraseExtension(node, "A"));
  EXPECT_EQ(*node.extensions, Json::parse(R"({"B": {}})"));
  EXPECT_TRUE(eraseExtension(node, "B"));
  EXPECT_FALSE(node.extensions.exists());
}

TEST(Extensions, ACopyKeepsItsOwn) {
  gltf::Node node = nodeWith(R"({"A": {"x": 1}})");
  const gltf::Node copy = node;
  changeExtension(node, "A")["x"] = 2;
  changeExtension(node, "B")["y"] = 3;
  EXPECT_EQ(*copy.extensions, Json::parse(R"({"A": {"x": 1}})"));
  EXPECT_EQ(*node.extensions, Json::parse(R"({"A": {"x": 2}, "B": {"y": 3}})"));
}

TEST(Extensions, DeclaringIsDoneOnceAndUndone) {
  gltf::Document document;
  document.extensionsRequired = {"A"};
  for (const char* name : {"A", "B", "A"}) declareExtension(document, name);
  EXPECT_THAT(document.extensionsUsed, ::testing::ElementsAre("A", "B"));
  undeclareExtension(document, "A");
  EXPECT_THAT(document.extensionsUsed, ::testing::ElementsAre("B"));
  EXPECT_TRUE(document.extensionsRequired.empty());
}

TEST(Extensions, OnlyThoseThatMayMatterAreWarnedOf) {
  Asset asset;
  asset.document.extensionsRequired = {"KHR_mesh_quantization", "ACME_bent_space",    "KHR_materials_unlit",
                                       "KHR_texture_basisu",    "ACME_more_vertices", "KHR_texture_transform"};
  warnOfUnknownExtensions(asset);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "unknown-extensions");
  EXPECT_EQ(asset.warnings.items()[0].count, 2u);
  EXPECT_EQ(asset.warnings.items()[0].where, "ACME_bent_space");
}

}  // namespace
}  // namespace limber
