#include "limber/asset/extensions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limber {
namespace {

TEST(Extensions, ErasingLeavesTheOthers) {
  Json node = Json::parse(R"({"extensions": {"A": {"x": 1}, "B": {}}, "name": "n"})");
  EXPECT_EQ(extensionOf(JsonView(node), "A").number("x", 0), 1);
  EXPECT_FALSE(extensionOf(JsonView(node), "C").exists());
  EXPECT_FALSE(eraseExtension(node, "C"));
  EXPECT_TRUE(eraseExtension(node, "A"));
  EXPECT_EQ(node, Json::parse(R"({"extensions": {"B": {}}, "name": "n"})"));
  EXPECT_TRUE(eraseExtension(node, "B"));
  EXPECT_EQ(node, Json::parse(R"({"name": "n"})"));
}

TEST(Extensions, UndeclaringTakesEmptyListsAway) {
  Json document = Json::parse(R"({"extensionsUsed": ["A", "B"], "extensionsRequired": ["A"]})");
  undeclareExtension(document, "A");
  EXPECT_EQ(document, Json::parse(R"({"extensionsUsed": ["B"]})"));
}

TEST(Extensions, OnlyThoseThatMayMatterAreWarnedOf) {
  Asset asset;
  asset.json()["extensionsRequired"] = {"KHR_mesh_quantization", "ACME_bent_space",    "KHR_materials_unlit",
                                        "KHR_texture_basisu",    "ACME_more_vertices", "KHR_texture_transform"};
  warnOfUnknownExtensions(asset);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "unknown-extensions");
  EXPECT_EQ(asset.warnings.items()[0].count, 2u);
  EXPECT_EQ(asset.warnings.items()[0].where, "ACME_bent_space");
}

}  // namespace
}  // namespace limber
