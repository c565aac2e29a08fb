#include "limber/preview/surface_colors.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/preview/image/image_decode.h"

namespace limber {
namespace {

// A triangle over the left half of a picture that is red above and blue below, two pixels high; the material halves
// all colours, and the vertices' own leave out green.
testing::GltfBuilder paintedTriangle() {
  testing::GltfBuilder model;
  const Index position = model.accessor(std::vector<float>{0, 1, 0, 0, 0, 0, 1, 0, 0}, 5126, "VEC3", 3);
  model.json["accessors"][position]["min"] = {0, 0, 0};
  model.json["accessors"][position]["max"] = {1, 1, 0};
  const Index uv = model.accessor(std::vector<float>{0, 0.25f, 0, 0.75f, 1, 0.75f}, 5126, "VEC2", 3);
  const Index color = model.accessor(std::vector<float>{1, 0, 1, 1, 0, 1, 1, 0, 1}, 5126, "VEC3", 3);
  const Index indices = model.accessor(std::vector<std::uint16_t>{0, 1, 2}, 5123, "SCALAR", 3);
  const Index view = model.view(encodePng({1, 2, {255, 0, 0, 0, 0, 255}}));
  model.push("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  model.push("samplers", {{"wrapS", 33071}, {"wrapT", 33071}});
  model.push("textures", {{"source", 0}, {"sampler", 0}});
  model.push("materials", {{"pbrMetallicRoughness",
                            {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
  const Json primitive = {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}},
                          {"indices", indices},
                          {"material", 0}};
  model.push("meshes", {{"primitives", Json::array({primitive})}});
  model.push("nodes", {{"mesh", 0}});
  model.push("scenes", {{"nodes", {0}}});
  return model;
}

TEST(SurfaceColors, AreMaterialTimesVerticesTimesPicture) {
  const Asset asset = readAsset(paintedTriangle().glb(), "triangle.glb");
  EXPECT_TRUE(hasColors(asset));
  const SurfaceColors colors(asset);
  EXPECT_LT((colors.at(0, {1, 0, 0}) - Vec3f(0.5f, 0, 0)).norm(), 1e-5);
  EXPECT_LT((colors.at(0, {0, 1, 0}) - Vec3f(0, 0, 0.5f)).norm(), 1e-5);
  EXPECT_LT((colors.at(0, {0, 0, 1}) - Vec3f(0, 0, 0.5f)).norm(), 1e-5);
  EXPECT_LT((colors.at(0, {0.5, 0.25, 0.25}) - Vec3f(0.25f, 0, 0.25f)).norm(), 1e-5) << "halfway, in linear light";
}

TEST(SurfaceColors, OfAModelThatSaysNothingAreNone) {
  testing::GltfBuilder model = paintedTriangle();
  model.json["meshes"][0]["primitives"][0].erase("material");
  EXPECT_TRUE(hasColors(readAsset(model.glb(), "vertices.glb")));
  model.json["meshes"][0]["primitives"][0]["attributes"].erase("COLOR_0");
  EXPECT_FALSE(hasColors(readAsset(model.glb(), "bare.glb")));
}

TEST(SurfaceColors, AsAPictureComeBackAsTheyWere) {
  const std::vector<Vec3f> pixels = {{1, 0, 0}, {0, 0.2158605f, 0}, {0, 0, 2}, {0, 0, 0}};
  const std::optional<DecodedImage> read = decodeImage(pngOfColors(2, pixels));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->colors.width, 2);
  EXPECT_EQ(read->colors.pixels, (std::vector<std::uint8_t>{255, 0, 0, 0, 128, 0, 0, 0, 255, 0, 0, 0}));
}

TEST(SurfaceColors, ABrokenPictureIsTold) {
  testing::GltfBuilder model = paintedTriangle();
  model.json["bufferViews"][model.json["images"][0]["bufferView"].get<Index>()]["byteLength"] = 12;
  const SurfaceColors colors(readAsset(model.glb(), "triangle.glb"));
  EXPECT_FALSE(colors.warnings().empty());
}

}  // namespace
}  // namespace limber
