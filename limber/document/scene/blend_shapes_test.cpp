#include "limber/document/scene/blend_shapes.h"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::SceneBuilder;

// A node that doubles, turns x to y, and lies aside.
const Json kTurnedNode = {{"mesh", 0},
                          {"scale", {2, 2, 2}},
                          {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
                          {"translation", {7, 8, 9}}};

// One tetrahedron below each of the nodes, each with a mesh of its own.
SceneBuilder tetrahedra(const std::vector<Json>& nodes) {
  SceneBuilder scene;
  std::vector<Index> roots;
  for (Json node : nodes) {
    node["mesh"] = scene.addTetrahedron();
    roots.push_back(scene.addNode(std::move(node)));
  }
  scene.addScene(roots);
  return scene;
}

void addStoredShape(SceneBuilder& scene, Index mesh, const std::vector<Vec3f>& offsets, const char* name = nullptr) {
  gltf::Attributes target;
  target.set("POSITION", scene.addPositions(offsets));
  scene.primitiveOf(mesh).targets.push_back(std::move(target));
  if (name) scene.asset().document.meshes[mesh].extras.change()["targetNames"].push_back(name);
}

std::vector<Vec3f> alike(const Vec3f& offset, std::size_t count = 4) {
  return std::vector<Vec3f>(count, offset);
}

std::vector<std::string> namesOf(const std::vector<BlendShape>& shapes) {
  std::vector<std::string> names;
  for (const BlendShape& shape : shapes) names.push_back(shape.name);
  return names;
}

TEST(BlendShapes, AreReadInWorldSpace) {
  SceneBuilder scene = tetrahedra({kTurnedNode});
  addStoredShape(scene, 0, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}, "smile");
  const Asset asset = scene.build();
  const std::vector<BlendShape> shapes = readBlendShapes(asset, collectGeometry(asset));
  ASSERT_THAT(namesOf(shapes), ElementsAre("smile"));
  const std::vector<Vec3f> expected = {{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {0, 0, 0}};
  for (std::size_t v = 0; v < 4; ++v) EXPECT_LT((shapes[0].offsets[v] - expected[v]).norm(), 1e-6) << v;
}

TEST(BlendShapes, OfOneNameAreOneWhicheverMeshesHaveThem) {
  SceneBuilder scene = tetrahedra({Json::object(), Json::object(), Json::object()});
  addStoredShape(scene, 0, alike({1, 0, 0}), "smile");
  addStoredShape(scene, 0, alike({0, 1, 0}), "frown");
  addStoredShape(scene, 2, alike({0, 0, 1}), "frown");
  const Asset asset = scene.build();
  const std::vector<BlendShape> shapes = readBlendShapes(asset, collectGeometry(asset));
  ASSERT_THAT(namesOf(shapes), ElementsAre("smile", "frown"));
  std::vector<Vec3f> smile = alike({0, 0, 0}, 12), frown = smile;
  for (std::size_t v = 0; v < 4; ++v) {
    smile[v] = {1, 0, 0};
    frown[v] = {0, 1, 0};
    frown[8 + v] = {0, 0, 1};
  }
  EXPECT_EQ(shapes[0].offsets, smile);
  EXPECT_EQ(shapes[1].offsets, frown);
}

TEST(BlendShapes, WithoutNamesHaveNumbers) {
  SceneBuilder scene = tetrahedra({Json::object()});
  addStoredShape(scene, 0, alike({1, 0, 0}), "smile");
  addStoredShape(scene, 0, alike({0, 1, 0}));
  EXPECT_THAT(namesOf(readBlendShapes(scene.asset(), collectGeometry(scene.asset()))), ElementsAre("smile", "shape_1"));
  for (const Json& names : {Json("smile"), Json::array({3, Json()}), Json::object()}) {
    scene.asset().document.meshes[0].extras.change()["targetNames"] = names;
    EXPECT_THAT(namesOf(readBlendShapes(scene.asset(), collectGeometry(scene.asset()))),
                ElementsAre("shape_0", "shape_1"));
  }
}

// Whatever the node, what is added is what is read again.
TEST(BlendShapes, AddedAreThoseThatAreReadAgain) {
  for (const Json& node : {Json::object(), kTurnedNode, Json{{"scale", {-1, 0.5, 3}}}}) {
    SceneBuilder scene = tetrahedra({node});
    Asset asset = scene.build();
    const Geometry geometry = collectGeometry(asset);
    std::vector<BlendShape> shapes = {{"up", alike({0, 0.5f, 0})},
                                      {"wide", {{1, 0, 0}, {-1, 0, 2}, {0, 0, 0}, {3, 1, 4}}}};
    EXPECT_THAT(addBlendShapes(asset, geometry, shapes), ElementsAre("up", "wide"));
    checkAsset(asset);
    EXPECT_EQ(testing::documentJson(asset)["meshes"][0]["weights"], Json::array({0.0, 0.0}));
    const std::vector<BlendShape> read = readBlendShapes(asset, geometry);
    ASSERT_THAT(namesOf(read), ElementsAre("up", "wide"));
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t v = 0; v < 4; ++v) EXPECT_LT((read[s].offsets[v] - shapes[s].offsets[v]).norm(), 1e-5) << node;
    }
  }
}

TEST(BlendShapes, GoToTheMeshesThatTheyMoveAndThatHaveNone) {
  SceneBuilder scene = tetrahedra({Json::object(), Json::object(), Json::object()});
  addStoredShape(scene, 1, alike({1, 0, 0}), "own");
  Asset asset = scene.build();
  std::vector<Vec3f> offsets = alike({0, 1, 0}, 12);
  for (std::size_t v = 8; v < 12; ++v) offsets[v] = {0, 0, 1e-9f};
  EXPECT_THAT(addBlendShapes(asset, collectGeometry(asset), {{"still", alike({0, 0, 1e-9f}, 12)}, {"up", offsets}}),
              ElementsAre("up"));
  const Json meshes = testing::documentJson(asset)["meshes"];
  EXPECT_EQ(meshes[0]["extras"]["targetNames"], Json::array({"up"}));
  EXPECT_EQ(meshes[1]["extras"]["targetNames"], Json::array({"own"}));
  EXPECT_EQ(meshes[1]["primitives"][0]["targets"].size(), 1u);
  EXPECT_FALSE(meshes[2]["primitives"][0].contains("targets"));
  EXPECT_FALSE(meshes[2].contains("extras"));
}

// Every primitive of a mesh must have as many.
TEST(BlendShapes, LeaveAMeshAloneOfWhichAPartIsNotShown) {
  SceneBuilder scene = tetrahedra({Json::object()});
  scene.asset().document.meshes[0].primitives.emplace_back().mode = 0;  // points, none
  Asset asset = scene.asset().clone();
  EXPECT_THAT(addBlendShapes(asset, collectGeometry(asset), {{"up", alike({0, 1, 0})}}), IsEmpty());
  EXPECT_EQ(testing::documentJson(asset), testing::documentJson(scene.asset()));
}

TEST(BlendShapes, OfAMeshOnAFlatNodeAreFinite) {
  SceneBuilder scene = tetrahedra({Json{{"scale", {1, 0, 1}}}});
  Asset asset = scene.build();
  addBlendShapes(asset, collectGeometry(asset), {{"up", alike({0, 1, 0})}});
  checkAsset(asset);
}

}  // namespace
}  // namespace limber
