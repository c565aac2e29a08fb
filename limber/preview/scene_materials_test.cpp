#include "limber/preview/scene_materials.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/preview/render.h"
#include "limber/preview/testing/rgba_png.h"

namespace limber {
namespace {

// A square that faces +Z, with texture coordinates from 0 at its upper left to 1 at its lower right, and a picture of
// four colours: red, green; blue, white.
testing::GltfBuilder texturedSquare(
    const Bytes& picture = encodePng({2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}})) {
  testing::GltfBuilder model;
  const std::vector<float> positions = {-1, 1, 0, 1, 1, 0, -1, -1, 0, 1, -1, 0};
  const Index position = model.accessor(positions, 5126, "VEC3", 4);
  model.json["accessors"][position]["min"] = {-1, -1, 0};
  model.json["accessors"][position]["max"] = {1, 1, 0};
  const Index uv = model.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}, 5126, "VEC2", 4);
  const Index indices = model.accessor(std::vector<std::uint16_t>{0, 2, 1, 1, 2, 3}, 5123, "SCALAR", 6);
  const Index view = model.view(picture);
  model.push("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  model.push("samplers", {{"wrapS", 33071}, {"wrapT", 33071}});
  model.push("textures", {{"source", 0}, {"sampler", 0}});
  model.push("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const Json primitive = {
      {"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"indices", indices}, {"material", 0}};
  model.push("meshes", {{"primitives", Json::array({primitive})}});
  model.push("nodes", {{"mesh", 0}});
  model.push("scenes", {{"nodes", {0}}});
  return model;
}

Scene sceneOf(const testing::GltfBuilder& model) {
  return makeScene(readAsset(model.glb(), "square.glb"));
}

Image frontView(const Scene& scene) {
  PreviewOptions options;
  options.width = options.height = 100;
  options.view = parseView("front");
  return render(scene, options);
}

std::vector<int> channelsAt(const Image& image, int x, int y) {
  const std::uint8_t* pixel = image.pixels.data() + 3 * (y * image.width + x);
  return {pixel[0], pixel[1], pixel[2]};
}

// The red square's corner of a picture whose alpha is 0 there, and 255 elsewhere.
std::vector<int> transparentCorner(const Json& material) {
  testing::GltfBuilder model =
      texturedSquare(testing::rgbaPng(2, 2, {255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}));
  model.json["materials"][0].update(material, true);
  return channelsAt(frontView(sceneOf(model)), 33, 33);
}

int redness(const std::vector<int>& channels) {
  return channels[0] - std::max(channels[1], channels[2]);
}

TEST(SceneMaterials, ThroughAlphaTheBackgroundIsSeenWhereTheMaterialSaysSo) {
  EXPECT_GT(redness(transparentCorner(Json::object())), 60) << "opaque whatever the alpha";
  for (const char* mode : {"MASK", "BLEND"}) {
    const std::vector<int> channels = transparentCorner({{"alphaMode", mode}});
    EXPECT_LT(std::abs(redness(channels)), 12) << mode;
    EXPECT_GT(channels[0], 150) << mode;
  }
  EXPECT_GT(redness(transparentCorner({{"alphaMode", "MASK"}, {"alphaCutoff", 0}})), 60);
}

TEST(SceneMaterials, HalfTransparentIsHalfwayToTheBackground) {
  testing::GltfBuilder model = texturedSquare();
  const std::vector<int> whole = channelsAt(frontView(sceneOf(model)), 35, 35);
  model.json["materials"][0]["alphaMode"] = "BLEND";
  model.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  const std::vector<int> half = channelsAt(frontView(sceneOf(model)), 35, 35);
  EXPECT_LT(redness(half), redness(whole) - 30);
  EXPECT_GT(redness(half), 10);
  model.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0};
  EXPECT_LT(std::abs(redness(channelsAt(frontView(sceneOf(model)), 35, 35))), 12);
}

TEST(SceneMaterials, APictureOnASquareIsSeenTheRightWayUp) {
  const Scene scene = sceneOf(texturedSquare());
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_TRUE(scene.materials[0].isOpaque);
  EXPECT_EQ(scene.materialOf, (std::vector<Index>{0, 0}));
  const Image image = frontView(scene);
  const std::vector<int> red = channelsAt(image, 35, 35), green = channelsAt(image, 65, 35),
                         blue = channelsAt(image, 35, 65), white = channelsAt(image, 65, 65);
  EXPECT_GT(red[0], 60 + std::max(red[1], red[2]));
  EXPECT_GT(green[1], 60 + std::max(green[0], green[2]));
  EXPECT_GT(blue[2], 60 + std::max(blue[0], blue[1]));
  EXPECT_GT(white[0], 150);
  EXPECT_LT(*std::max_element(white.begin(), white.end()) - *std::min_element(white.begin(), white.end()), 30);
}

TEST(SceneMaterials, TheTransformOfTheCoordinatesIsFollowed) {
  testing::GltfBuilder model = texturedSquare();
  model.json["extensionsUsed"] = {"KHR_texture_transform"};
  model.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", EIGEN_PI / 2}};
  const Scene scene = sceneOf(model);
  // (u, v) is scaled to (2u, 3v), turned to (3v, -2u), moved.
  const std::vector<Vec2f> expected = {{0.5f, 0.25f}, {0.5f, -1.75f}, {3.5f, 0.25f}, {3.5f, -1.75f}};
  ASSERT_EQ(scene.uvs.size(), expected.size());
  for (std::size_t v = 0; v < expected.size(); ++v) EXPECT_LT((scene.uvs[v] - expected[v]).norm(), 1e-5f) << v;
}

TEST(SceneMaterials, WhatCannotBeDrawnIsCountedAndPlain) {
  testing::GltfBuilder model = texturedSquare();
  model.json["images"][0] = {{"uri", "missing.png"}};
  const Scene scene = sceneOf(model);
  EXPECT_TRUE(scene.materials.empty());
  EXPECT_TRUE(scene.materialOf.empty());
  ASSERT_EQ(scene.warnings.items().size(), 1u);
  EXPECT_EQ(scene.warnings.items()[0].kind, "undrawn-textures");
  PreviewOptions options;
  options.width = options.height = 32;
  EXPECT_EQ(render(scene, options).width, 32);
}

TEST(SceneMaterials, OneTextureOnSeveralPartsIsDecodedOnce) {
  testing::GltfBuilder model = texturedSquare();
  model.json["meshes"][0]["primitives"].push_back(model.json["meshes"][0]["primitives"][0]);
  model.json["meshes"][0]["primitives"].push_back(model.json["meshes"][0]["primitives"][0]);
  model.json["meshes"][0]["primitives"][2].erase("material");
  const Scene scene = sceneOf(model);
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materialOf, (std::vector<Index>{0, 0, 0, 0, kNoIndex, kNoIndex}));
}

}  // namespace
}  // namespace limber
