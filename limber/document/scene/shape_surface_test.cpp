#include "limber/document/scene/shape_surface.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/clip/clip_moment.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/testing/gltf_builder.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

// A square with a shape that moves its vertices 1 and 3; "grow" brings it from 0 to 1 within two seconds.
Asset growingSquare() {
  testing::GltfBuilder model = testing::everythingModel();
  const float none = std::nanf("");
  const Index times = model.accessor<float>({0, 2, 3, 2.5f}, 5126, "SCALAR", 4);
  const Index weights = model.accessor<float>({0, 1, none, 7}, 5126, "SCALAR", 4);
  model.push("animations",
             {{"name", "grow"},
              {"samplers", Json::array({{{"input", times}, {"output", weights}}})},
              {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 2}, {"path", "weights"}}}}})}});
  return readAsset(model.glb(), "growing.glb");
}

TEST(ShapeSurface, WeightsAreTheNodesOrItsMeshs) {
  Asset asset = growingSquare();
  EXPECT_THAT(readShapeWeights(asset)[2], ElementsAre(0));
  EXPECT_TRUE(readShapeWeights(asset)[0].empty());
  asset.document.meshes[0].weights = {0.25};
  EXPECT_THAT(readShapeWeights(asset)[2], ElementsAre(0.25f));
  asset.document.nodes[2].weights = {0.5};
  EXPECT_THAT(readShapeWeights(asset)[2], ElementsAre(0.5f));
  EXPECT_THAT(readShapeWeights(asset, animationNamed(asset.document, "turn"), 1)[2], ElementsAre(0.5f))
      << "an animation that moves none";
}

TEST(ShapeSurface, AnAnimationMovesThem) {
  Asset asset = growingSquare();
  const std::optional<Index> grow = animationNamed(asset.document, "grow");
  ASSERT_TRUE(grow);
  EXPECT_FALSE(animationNamed(asset.document, "shrink"));
  EXPECT_THAT(readShapeWeights(asset, grow, 0.5)[2], ElementsAre(0.25f));
  EXPECT_THAT(readShapeWeights(asset, grow, 9)[2], ElementsAre(1)) << "keys that are none are passed over";
  EXPECT_EQ(shapeDuration(asset, *grow), 3);
  EXPECT_EQ(shapeDuration(asset, 0), 0);
  writeShapeWeights(asset, shapesAt(asset, {"grow", 1}));
  EXPECT_THAT(asset.document.nodes[2].weights, ElementsAre(0.5));
  EXPECT_NO_THROW(poseAt(asset, readSkeleton(asset), {"grow", 1})) << "it moves no joint, but it is a clip";
}

TEST(ShapeSurface, VerticesGoWhereTheWeightsHaveThem) {
  const Asset asset = growingSquare();
  Geometry geometry = collectGeometry(asset);
  const std::vector<Vec3f> plain = geometry.positions;
  std::vector<Vec3f> normals = readNormals(asset, geometry);
  const std::vector<Vec3f> plainNormals = normals;
  moveByShapes(asset, {{}, {}, {0.5f}, {}}, geometry, &normals);
  EXPECT_EQ(geometry.positions[0], plain[0]);
  EXPECT_LT((geometry.positions[1] - plain[1] - 0.5f * Vec3f(1, 2, 3)).norm(), 1e-6f);
  EXPECT_LT((geometry.positions[3] - plain[3] - 0.5f * Vec3f(4, 5, 6)).norm(), 1e-6f);
  EXPECT_EQ(normals, plainNormals) << "the shape has none";
  moveByShapes(asset, {{}, {}, {0}, {}}, geometry);
  EXPECT_EQ(geometry.positions, plain);
}

TEST(ShapeSurface, AFewNodesMustNotAskForGigabytes) {
  Asset asset = growingSquare();
  asset.document.meshes[0].primitives[0].targets.resize(5000);
  gltf::Node shows;
  shows.mesh = 0;
  asset.document.nodes.resize(5000, shows);
  EXPECT_THROW(readShapeWeights(asset), Error);
}

TEST(ShapeSurface, OfSeveralChannelsTheLastWholeOneCounts) {
  Asset asset = growingSquare();
  gltf::Animation& grow = asset.document.animations[*animationNamed(asset.document, "grow")];
  const Index times = addFloatAccessor(asset, std::vector<float>{0, 1}, 1);
  const Index whole = addFloatAccessor(asset, std::vector<float>{3, 3}, 1);
  const Index part = addFloatAccessor(asset, std::vector<float>{9}, 1);
  for (const Index values : {whole, part}) {
    gltf::AnimationChannel channel = grow.channels[0];
    channel.sampler = addElement(grow.samplers, {{}, times, values, Interpolation::kLinear});
    grow.channels.push_back(std::move(channel));
  }
  EXPECT_THAT(readShapeWeights(asset, animationNamed(asset.document, "grow"), 0.5)[2], ElementsAre(3));
}

TEST(ShapeSurface, ManyNodesOnOneLongSamplerAreRefused) {
  Asset asset = growingSquare();
  const std::optional<Index> clip = animationNamed(asset.document, "grow");
  constexpr std::size_t kKeys = 1'000'000;
  std::vector<float> times(kKeys);
  for (std::size_t k = 0; k < kKeys; ++k) times[k] = static_cast<float>(k);
  gltf::Animation& grow = asset.document.animations[*clip];
  grow.samplers[0].input = addFloatAccessor(asset, times, 1);
  grow.samplers[0].output = addFloatAccessor(asset, std::vector<float>(kKeys), 1);
  gltf::Node shows;
  shows.mesh = 0;
  for (int i = 0; i < 100; ++i) {
    gltf::AnimationChannel channel = grow.channels[0];
    channel.target.node = addElement(asset.document.nodes, gltf::Node(shows));
    grow.channels.push_back(std::move(channel));
  }
  try {
    readShapeWeights(asset, clip, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
  }
}

}  // namespace
}  // namespace limber
