#include "limber/actions/parts/part_materials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

std::vector<std::string> materialNames(const Asset& asset) {
  std::vector<std::string> names;
  for (const gltf::Material& material : asset.document.materials) names.push_back(material.name);
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
    gltf::Material cloth, skin;
    cloth.name = "cloth";
    cloth.pbrMetallicRoughness.emplace().baseColorFactor = Vec4(0.5, 1, 1, 0.25);
    skin.name = "skin";
    skin.doubleSided = true;
    builder.asset().document.materials = {cloth, skin};
    const Index mesh = builder.addMesh(std::move(primitives), "body");
    builder.addNode({{"name", "body"}, {"mesh", mesh}});
    builder.addScene({0});
    parts.names = {"arm", "leg"};
    asset = std::move(builder.asset());
  }
};

TEST(PartMaterials, PartsOfSeveralMaterialsHaveThemAllByName) {
  TwoMaterials model;
  const Geometry geometry = collectGeometry(model.asset);
  paintParts(model.asset, geometry, model.parts, std::vector<Vec3f>{{0.5f, 0.5f, 1}, {1, 0, 0}});
  EXPECT_THAT(materialNames(model.asset), ::testing::IsSupersetOf({"arm_cloth", "arm_skin", "leg_cloth", "leg_skin"}));
  for (const gltf::Material& material : model.asset.document.materials) {
    EXPECT_EQ(material.doubleSided, material.name.ends_with("skin"));
    if (material.name == "arm_cloth") {
      EXPECT_EQ(material.pbrMetallicRoughness.value().baseColorFactor, Vec4(0.25, 0.5, 1, 0.25));
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
  for (const gltf::Material& material : model.asset.document.materials) {
    if (!material.name.ends_with("cloth")) {
      EXPECT_FALSE(material.pbrMetallicRoughness);
      continue;
    }
    EXPECT_EQ(material.pbrMetallicRoughness.value().baseColorFactor, Vec4(0.5, 1, 1, 0.25));
  }
  Asset plain = testing::assetOf(testing::icosphere(1));
  const SurfaceParts one{std::vector<Index>(80, 0), {"all"}};
  paintParts(plain, collectGeometry(plain), one, {});
  EXPECT_THAT(materialNames(plain), ::testing::ElementsAre("all"));
}

}  // namespace
}  // namespace limber
