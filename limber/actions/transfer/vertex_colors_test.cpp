#include "limber/actions/transfer/vertex_colors.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using testing::SceneBuilder;

const std::vector<Vec3f> kCorners = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25f, 2, -1}};

// A tetrahedron in red by its material, which is metal.
Asset redTetrahedron() {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.primitiveOf(mesh).material = 0;
  testing::editDocument(scene.asset(), [](Json& json) {
    json["materials"] = Json::array(
        {{{"name", "paint"},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {1, 0, 0, 0.5}}, {"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 1}}}}});
    json["textures"] = Json::array({{{"source", 0}}});
    json["images"] = Json::array({{{"uri", "paint.png"}}});
  });
  scene.addNode({{"mesh", mesh}});
  scene.addScene({0});
  return scene.build();
}

std::vector<float> colorsOf(const Asset& asset) {
  return readFloats(asset, asset.document.meshes[0].primitives[0].attributes.find("COLOR_0").value());
}

TEST(VertexColors, StandInTheFileAndTheMaterialIsWhite) {
  Asset asset = redTetrahedron();
  setVertexColors(asset, collectGeometry(asset), kCorners);
  checkAsset(asset);
  EXPECT_EQ(colorsOf(asset), (std::vector<float>{1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0.25f, 1, 0, 1}));
  const Json material = testing::documentJson(asset)["materials"][0];
  EXPECT_EQ(material.at("name"), "paint");
  const Json& base = material.at("pbrMetallicRoughness");
  EXPECT_EQ(base.at("baseColorFactor"), Json::array({1, 1, 1, 0.5}));
  EXPECT_EQ(base.at("metallicFactor"), 1);
  EXPECT_FALSE(base.contains("baseColorTexture"));
}

TEST(VertexColors, TakeThePlaceOfOthersAndLeaveNoneBehind) {
  Asset asset = redTetrahedron();
  const std::size_t bare = asset.document.accessors.size();
  setVertexColors(asset, collectGeometry(asset), kCorners);
  setVertexColors(asset, collectGeometry(asset), std::vector<Vec3f>(4, Vec3f(0.5f, 0.5f, 0)));
  EXPECT_EQ(asset.document.accessors.size(), bare + 1);
  EXPECT_EQ(colorsOf(asset)[4], 0.5f);
}

TEST(VertexColors, OfAMeshThatIsShownTwiceAreThoseOfTheFirst) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}});
  scene.addNode({{"mesh", mesh}, {"translation", {3, 0, 0}}});
  scene.addScene({0, 1});
  Asset asset = scene.build();
  std::vector<Vec3f> colors = kCorners;
  colors.resize(8, Vec3f::Ones());
  setVertexColors(asset, collectGeometry(asset), colors);
  checkAsset(asset);
  EXPECT_EQ(colorsOf(asset)[1], 0);
  ASSERT_EQ(asset.document.materials.size(), 1u) << "a plain one, as there was none";
  const Json base = testing::documentJson(asset)["materials"][0].at("pbrMetallicRoughness");
  EXPECT_EQ(base.at("baseColorFactor"), Json::array({1, 1, 1, 1}));
  EXPECT_EQ(base.at("metallicFactor"), 0);
}

TEST(VertexColors, OneForEachVertex) {
  Asset asset = redTetrahedron();
  const Bytes before = writeGlb(asset);
  EXPECT_THROW(setVertexColors(asset, collectGeometry(asset), std::vector<Vec3f>(3)), Error);
  EXPECT_EQ(writeGlb(asset), before);
}

}  // namespace
}  // namespace limber
