#include "limber/parts/part_materials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/asset/scene_graph.h"
#include "limber/mesh/testing/shapes.h"
#include "limber/parts/testing/part_meshes_made.h"

namespace limber {
namespace {

std::vector<std::string> materialNames(const Asset& asset) {
  std::vector<std::string> names;
  for (const Json& material : elements(asset, "materials")) names.push_back(nameOf(material));
  return names;
}

// Two primitives of one mesh, cloth and skin, each half in part "arm" and half in part "leg".
struct TwoMaterials {
  Asset asset;
  SurfaceParts parts;

  TwoMaterials() {
    testing::SceneBuilder builder;
    const TriMesh ball = testing::icosphere(1);
    Json primitives = Json::array();
    for (int material = 0; material < 2; ++material) {
      Json primitive = builder.primitive(ball.positions, ball.triangles);
      primitive["material"] = material;
      primitives.push_back(std::move(primitive));
      for (Index t = 0; t < ball.triangleCount(); ++t) parts.partOf.push_back(t % 2);
    }
    builder.json()["materials"] = {
        {{"name", "cloth"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 1, 0.25}}}}},
        {{"name", "skin"}, {"doubleSided", true}}};
    const Index mesh = builder.addMesh(std::move(primitives), "body");
    builder.addNode({{"name", "body"}, {"mesh", mesh}});
    builder.json()["scenes"] = Json::array({{{"nodes", {0}}}});
    parts.names = {"arm", "leg"};
    asset = std::move(builder.asset());
  }
};

TEST(PartMaterials, PartsOfSeveralMaterialsHaveThemAllByName) {
  TwoMaterials model;
  const Geometry geometry = collectGeometry(model.asset);
  paintParts(model.asset, geometry, model.parts, std::vector<Vec3f>{{0.5f, 0.5f, 1}, {1, 0, 0}});
  EXPECT_THAT(materialNames(model.asset), ::testing::IsSupersetOf({"arm_cloth", "arm_skin", "leg_cloth", "leg_skin"}));
  for (const Json& material : elements(model.asset, "materials")) {
    const bool isSkin = nameOf(material).ends_with("skin");
    EXPECT_EQ(material.contains("doubleSided"), isSkin);
    if (nameOf(material) == "arm_cloth") {
      EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], Json({0.25, 0.5, 1.0, 0.25}));
    }
  }
  // The same triangles, each with its part's material.
  const Geometry painted = collectGeometry(model.asset);
  EXPECT_EQ(painted.triangles.size(), geometry.triangles.size());
  EXPECT_EQ(painted.instances.size(), 4u);
}

TEST(PartMaterials, WithoutTintsColoursStayAndWithoutMaterialsNoneIsInvented) {
  TwoMaterials model;
  const Geometry geometry = collectGeometry(model.asset);
  paintParts(model.asset, geometry, model.parts, {});
  for (const Json& material : elements(model.asset, "materials")) {
    if (!nameOf(material).ends_with("cloth")) {
      EXPECT_FALSE(material.contains("pbrMetallicRoughness"));
      continue;
    }
    EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], Json({0.5, 1, 1, 0.25}));
  }
  Asset plain = testing::assetOf(testing::icosphere(1));
  const SurfaceParts one{std::vector<Index>(80, 0), {"all"}};
  paintParts(plain, collectGeometry(plain), one, {});
  EXPECT_THAT(materialNames(plain), ::testing::ElementsAre("all"));
}

}  // namespace
}  // namespace limber
