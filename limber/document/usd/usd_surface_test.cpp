#include "limber/document/usd/usd_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/text/numbers.h"
#include "limber/document/gltf/gltf_json.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

UsdSurface surfaceOf(const Json& material) {
  const Json json = {{"asset", {{"version", "2.0"}}},
                     {"images", {{{"uri", "a.png"}}}},
                     {"textures", {{{"source", 0}}}},
                     {"materials", {material}}};
  return usdSurface(gltf::documentOf(json), 0);
}

const UsdInput& input(const UsdSurface& surface, std::string_view name) {
  for (const UsdInput& each : surface.inputs) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(std::string(name));
}
float number(const UsdSurface& surface, std::string_view name) {
  return std::get<float>(input(surface, name).value);
}

// glTF's transform of a point (as limber/preview draws it), against USD's of the same point with v turned round.
TEST(UsdSurface, TextureTransformsGiveTheSamePlaces) {
  const Json transform = {{"offset", {0.1, 0.2}}, {"scale", {2, 0.5}}, {"rotation", 0.7}, {"texCoord", 1}};
  const UsdSurface surface =
      surfaceOf({{"pbrMetallicRoughness",
                  {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
  EXPECT_THAT(surface.uvSets, ElementsAre(1));
  const UsdUvTransform usd = input(surface, "diffuseColor").texture.value().transform.value();
  for (const auto& [u, v] : {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(0.3, 0.8)}) {
    const double x = 2 * u, y = 0.5 * v, c = std::cos(0.7), s = std::sin(0.7);
    const Vec2f expected(static_cast<float>(c * x + s * y + 0.1), static_cast<float>(1 - (c * y - s * x + 0.2)));
    const Vec2f scaled = Vec2f(static_cast<float>(u), static_cast<float>(1 - v)).cwiseProduct(usd.scale);
    const Vec2f placed = Eigen::Rotation2Df(usd.degrees * static_cast<float>(kDegree)) * scaled + usd.translation;
    EXPECT_LT((placed - expected).norm(), 1e-6f);
  }
}

TEST(UsdSurface, StrengthsBecomeScaleAndBias) {
  const UsdSurface surface =
      surfaceOf({{"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                 {"occlusionTexture", {{"index", 0}, {"strength", 0.25}}},
                 {"emissiveFactor", {1, 0.5, 0}},
                 {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}}});
  const UsdTexture& normal = input(surface, "normal").texture.value();
  EXPECT_EQ(normal.scale, Vec4f(1, 1, 2, 1));
  EXPECT_EQ(normal.bias, Vec4f(-0.5f, -0.5f, -1, 0));
  const UsdTexture& occlusion = input(surface, "occlusion").texture.value();
  EXPECT_EQ(occlusion.scale.x() * 0 + occlusion.bias.x(), 0.75f);  // in the dark
  EXPECT_EQ(occlusion.scale.x() * 1 + occlusion.bias.x(), 1);
  EXPECT_EQ(std::get<Vec3f>(input(surface, "emissiveColor").value), Vec3f(3, 1.5f, 0));
}

TEST(UsdSurface, UnlitShinesByItself) {
  const UsdSurface surface = surfaceOf({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 1}}}},
                                        {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  EXPECT_EQ(std::get<Vec3f>(input(surface, "diffuseColor").value), Vec3f(0, 0, 0));
  EXPECT_EQ(std::get<Vec3f>(input(surface, "emissiveColor").value), Vec3f(1, 0.5f, 0.25f));
  EXPECT_EQ(surface.colorInput, "emissiveColor");
}

TEST(UsdSurface, GlossinessIsWhatRoughnessLacks) {
  const Json gloss = {
      {"glossinessFactor", 0.25}, {"specularFactor", {0.5, 0.5, 0.5}}, {"specularGlossinessTexture", {{"index", 0}}}};
  const UsdSurface surface = surfaceOf({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", gloss}}}});
  EXPECT_EQ(std::get<int>(input(surface, "useSpecularWorkflow").value), 1);
  const UsdTexture& rough = input(surface, "roughness").texture.value();
  EXPECT_EQ(rough.scale.w() * 1 + rough.bias.w(), 0.75f);
  EXPECT_EQ(number(surface, "roughness"), 0.75f);
}

TEST(UsdSurface, OtherExtensionsAreNamed) {
  const UsdSurface surface = surfaceOf({{"extensions",
                                         {{"KHR_materials_ior", {{"ior", 1.25}}},
                                          {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}},
                                          {"KHR_materials_sheen", Json::object()}}}});
  EXPECT_EQ(number(surface, "ior"), 1.25f);
  EXPECT_EQ(number(surface, "clearcoat"), 0.5f);
  EXPECT_THAT(surface.unsaid, ElementsAre("KHR_materials_sheen"));
}

}  // namespace
}  // namespace limber
