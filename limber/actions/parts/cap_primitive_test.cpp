#include "limber/actions/parts/cap_primitive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/weight_attributes.h"

namespace limber {
namespace {

// A square in the plane z = 0 as a skinned primitive with a morph target: two corners follow joint 1, two joint 4, and
// the corners' weights are 1, 1, 1 and, of joints 4 and 2, 0.5 each.
struct SkinnedSquare {
  Asset asset;
  Geometry geometry;
  std::vector<gltf::Primitive> primitives;
  PartCap fan;
  std::vector<ModelVertex> loop;

  explicit SkinnedSquare(const Affine& toWorld = Affine::Identity()) {
    const std::vector<Vec3f> corners = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    testing::SceneBuilder builder;
    gltf::Primitive& primitive = primitives.emplace_back();
    primitive.attributes.set("POSITION", builder.addPositions(corners));
    primitive.indices = builder.addIndices({0, 1, 2, 0, 2, 3});
    asset = std::move(builder.asset());
    const std::vector<std::uint8_t> joints = {1, 0, 0, 0, 1, 0, 0, 0, 4, 0, 0, 0, 4, 2, 0, 0};
    const std::vector<float> weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0};
    primitive.attributes.set("JOINTS_0", addAccessor(asset, {4, 4, ComponentType::kU8, false}, joints));
    primitive.attributes.set("WEIGHTS_0", addFloatAccessor(asset, weights, 4));
    const Index offsets = addFloatAccessor(asset, std::vector<float>{0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
    primitive.targets.emplace_back().set("POSITION", offsets);
    geometry.positions = corners;
    geometry.instances.emplace_back().vertexCount = 4;
    geometry.instances[0].toWorld = toWorld;
    fan.loop = {0, 1, 2, 3};
    fan.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    fan.hasMiddle = true;
    fan.normal = Vec3::UnitZ();
    for (Index v = 0; v < 4; ++v) loop.push_back({0, v});
  }

  gltf::Primitive write(bool skinned, std::size_t targets) {
    CapPrimitive caps(asset, geometry, primitives);
    EXPECT_TRUE(caps.empty());
    caps.add(fan, loop);
    EXPECT_FALSE(caps.empty());
    return caps.write(asset, 3, skinned, targets);
  }
  std::vector<float> read(const gltf::Attributes& attributes, const char* name) const {
    return readFloats(asset, attributes.find(name).value());
  }
};

TEST(CapPrimitive, TheMiddleOfAFanIsTheMeanOfItsLoop) {
  SkinnedSquare square;
  const gltf::Primitive primitive = square.write(true, 1);
  const std::vector<float> positions = square.read(primitive.attributes, "POSITION");
  ASSERT_EQ(positions.size(), 15u);
  EXPECT_EQ(std::vector<float>(positions.end() - 3, positions.end()), (std::vector<float>{1, 1, 0}));
  const std::vector<float> offsets = square.read(primitive.targets.at(0), "POSITION");
  EXPECT_EQ(std::vector<float>(offsets.end() - 3, offsets.end()), (std::vector<float>{0, 0, 1}));
  const std::vector<float> normals = square.read(primitive.attributes, "NORMAL");
  for (std::size_t v = 0; v < 5; ++v) EXPECT_EQ(normals[3 * v + 2], 1);
  const std::vector<InfluenceSet> sets = readInfluenceSets(square.asset, primitive);
  ASSERT_EQ(sets.size(), 1u);
  std::map<Index, float> middle;
  for (std::size_t i = 16; i < 20; ++i) {
    if (sets[0].weights[i] > 0) middle[sets[0].joints[i]] = sets[0].weights[i];
  }
  EXPECT_EQ(middle, (std::map<Index, float>{{1, 0.5f}, {4, 0.375f}, {2, 0.125f}}));
  EXPECT_EQ(primitive.material, 3u);
}

TEST(CapPrimitive, StaticModelsGetNoWeights) {
  SkinnedSquare square;
  const gltf::Primitive primitive = square.write(false, 0);
  EXPECT_FALSE(primitive.attributes.find("JOINTS_0"));
  EXPECT_TRUE(primitive.targets.empty());
}

TEST(CapPrimitive, MirroredInstancesTurnTheirTrianglesOver) {
  for (const double scale : {1.0, -1.0}) {
    Affine toWorld = Affine::Identity();
    toWorld.linear()(0, 0) = scale;
    SkinnedSquare square(toWorld);
    const gltf::Primitive primitive = square.write(false, 0);
    const std::vector<float> corners = readFloats(square.asset, primitive.indices.value());
    EXPECT_THAT(std::vector<float>(corners.begin(), corners.begin() + 3),
                scale > 0 ? ::testing::ElementsAre(0, 1, 4) : ::testing::ElementsAre(0, 4, 1));
  }
}

}  // namespace
}  // namespace limber
