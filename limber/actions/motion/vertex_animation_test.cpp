#include "limber/actions/motion/vertex_animation.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/known_error.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

using testing::SceneBuilder;

// A tetrahedron on node 0, in a scene of nodes that are added behind it.
SceneBuilder shownTetrahedron() {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addScene({scene.addNode({{"mesh", mesh}})});
  return scene;
}

void addTarget(SceneBuilder& scene, const Vec3f& offset) {
  const std::vector<Vec3f> offsets(4, offset);
  scene.primitiveOf(0).targets.emplace_back().set("POSITION", scene.addPositions(offsets));
}

// A clip of one channel.
void animate(SceneBuilder& scene, const std::string& clip, Index node, const std::string& path,
             const std::vector<float>& times, const std::vector<float>& values,
             Interpolation interpolation = Interpolation::kLinear) {
  const Index components = path == "weights" ? 1 : path == "rotation" ? 4 : 3;
  gltf::Animation& added = scene.asset().document.animations.emplace_back();
  added.name = clip;
  gltf::AnimationSampler& sampler = added.samplers.emplace_back();
  sampler.input = addFloatAccessor(scene.asset(), times, 1, 0, true);
  sampler.output = addFloatAccessor(scene.asset(), values, components);
  sampler.interpolation = interpolation;
  gltf::AnimationChannel& channel = added.channels.emplace_back();
  channel.target.node = node;
  channel.target.path = path;
}

VertexAnimation animationOf(SceneBuilder& scene, const VertexAnimationOptions& options = {}) {
  Progress progress;
  return readVertexAnimation(scene.asset(), options, progress);
}

Vec3f vertexAt(const VertexAnimation& animation, Index vertex, Index frame) {
  return animation.sequence.at(animation.pointOf[vertex], frame);
}

TEST(VertexAnimation, OfAMovedNodeIsTheNodesMotion) {
  SceneBuilder scene = shownTetrahedron();
  animate(scene, "slide", 0, "translation", {0, 1}, {0, 0, 0, 4, 2, 0});
  const VertexAnimation animation = animationOf(scene, {"", 4.0});
  ASSERT_EQ(animation.sequence.frameCount(), 5u);
  const std::vector<Vec3f> rest = SceneBuilder::tetrahedron();
  for (Index f = 0; f < 5; ++f) {
    for (Index v = 0; v < 4; ++v) {
      EXPECT_LT((vertexAt(animation, v, f) - rest[v] - 0.25f * static_cast<float>(f) * Vec3f(4, 2, 0)).norm(), 1e-5)
          << v << " " << f;
    }
  }
  ASSERT_EQ(animation.clips.size(), 1u);
  EXPECT_EQ(animation.clips[0].name, "slide");
  EXPECT_EQ(animation.clips[0].framesPerSecond, 4);
}

// Against the interpolations as glTF's specification writes them (appendix C).
TEST(VertexAnimation, MorphTargetsFollowTheInterpolationOfTheirWeights) {
  const auto heights = [](Interpolation interpolation, const std::vector<float>& values) {
    SceneBuilder scene = shownTetrahedron();
    addTarget(scene, {0, 1, 0});
    animate(scene, "grow", 0, "weights", {0, 2}, values, interpolation);
    const VertexAnimation animation = animationOf(scene, {"", 2.0});
    std::vector<double> result;
    for (Index f = 0; f < animation.sequence.frameCount(); ++f) result.push_back(vertexAt(animation, 0, f).y());
    return result;
  };
  EXPECT_EQ(heights(Interpolation::kStep, {0.25f, 1}), (std::vector<double>{0.25, 0.25, 0.25, 0.25, 1}));
  EXPECT_EQ(heights(Interpolation::kLinear, {0, 1}), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  const std::vector<double> cubic = heights(Interpolation::kCubic, {0, 0.5f, 0.25f, -1, 1, 0});
  ASSERT_EQ(cubic.size(), 5u);
  for (int f = 0; f < 5; ++f) {
    const double t = f / 4.0, t2 = t * t, t3 = t2 * t, span = 2;
    const double hermite =
        (2 * t3 - 3 * t2 + 1) * 0.5 + span * (t3 - 2 * t2 + t) * 0.25 + (-2 * t3 + 3 * t2) * 1 + span * (t3 - t2) * -1;
    EXPECT_NEAR(cubic[static_cast<std::size_t>(f)], hermite, 1e-5) << f;
  }
}

TEST(VertexAnimation, WeightsThatNothingAnimatesStayAsTheFileHasThem) {
  SceneBuilder scene = shownTetrahedron();
  addTarget(scene, {0, 1, 0});
  addTarget(scene, {0, 0, 1});
  scene.asset().document.meshes[0].weights = {0.5, 0.25};
  animate(scene, "slide", 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  VertexAnimation animation = animationOf(scene, {"", 1.0});
  EXPECT_LT((vertexAt(animation, 0, 1) - Vec3f(1, 0.5f, 0.25f)).norm(), 1e-6);
  EXPECT_EQ(animation.sequence.rest[animation.pointOf[0]], Vec3f(0, 0, 0)) << "bound without morphs";
  scene.node(0).weights = {0, 1};
  EXPECT_LT((vertexAt(animationOf(scene, {"", 1.0}), 0, 1) - Vec3f(1, 0, 1)).norm(), 1e-6) << "the node's count more";
}

TEST(VertexAnimation, ASkinMovesVerticesByLinearBlend) {
  SceneBuilder scene = shownTetrahedron();
  const Index a = scene.addNode({{"name", "a"}}), b = scene.addNode({{"name", "b"}});
  scene.asset().document.scenes[0].nodes = {0, a, b};
  scene.node(0).skin = scene.addSkin({a, b}, {Affine::Identity(), Affine::Identity()});
  scene.bindRigidly(0, {0, 0, 1, 1});
  animate(scene, "lift", b, "translation", {0, 1}, {0, 0, 0, 0, 3, 0});
  const VertexAnimation animation = animationOf(scene, {"", 1.0});
  const std::vector<Vec3f> rest = SceneBuilder::tetrahedron();
  for (Index v = 0; v < 4; ++v) {
    EXPECT_LT((vertexAt(animation, v, 1) - rest[v] - Vec3f(0, v < 2 ? 0 : 3, 0)).norm(), 1e-5) << v;
  }
}

TEST(VertexAnimation, VerticesThatBeginAndMoveAlikeAreOnePoint) {
  SceneBuilder scene;
  const std::vector<Vec3f> corners = SceneBuilder::tetrahedron();
  std::vector<Vec3f> twice = corners, offsets(8, Vec3f::Zero());
  twice.insert(twice.end(), corners.begin(), corners.end());
  offsets[5] = offsets[2] = {0, 0, 1};
  offsets[6] = {0, 0, 1};
  std::vector<Triangle> triangles = SceneBuilder::tetrahedronTriangles();
  for (Triangle t : SceneBuilder::tetrahedronTriangles()) triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  scene.addScene({scene.addNode({{"mesh", scene.addMesh(Json::array({scene.primitive(twice, triangles)}))}})});
  scene.primitiveOf(0).targets.emplace_back().set("POSITION", scene.addPositions(offsets));
  animate(scene, "grow", 0, "weights", {0, 1}, {0, 1});
  const VertexAnimation animation = animationOf(scene);
  EXPECT_EQ(animation.pointOf.size(), 8u);
  EXPECT_EQ(animation.sequence.pointCount(), 5u);
  EXPECT_EQ(animation.pointOf[0], animation.pointOf[4]);
  EXPECT_NE(animation.pointOf[1], animation.pointOf[5]) << "they part";
  EXPECT_EQ(animation.pointOf[2], animation.pointOf[6]);
}

TEST(VertexAnimation, KeysThatMakeNoSenseAreLeftOut) {
  SceneBuilder scene = shownTetrahedron();
  addTarget(scene, {0, 1, 0});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  animate(scene, "grow", 0, "weights", {0, 1, 1, 2}, {0, nan, 0.5f, 1});
  const VertexAnimation animation = animationOf(scene, {"", 1.0});
  ASSERT_EQ(animation.sequence.frameCount(), 3u);
  EXPECT_FLOAT_EQ(vertexAt(animation, 0, 1).y(), 0.5f);
  EXPECT_FLOAT_EQ(vertexAt(animation, 0, 2).y(), 1);
}

TEST(VertexAnimation, ClipsStandOneBehindTheOtherAndAreChosenByName) {
  SceneBuilder scene = shownTetrahedron();
  animate(scene, "right", 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  animate(scene, "up", 0, "translation", {0, 2}, {0, 0, 0, 0, 2, 0});
  const VertexAnimation both = animationOf(scene, {"", 2.0});
  ASSERT_EQ(both.clips.size(), 2u);
  EXPECT_EQ(both.clips[1].first, both.clips[0].count);
  EXPECT_EQ(both.sequence.frameCount(), 3u + 5u);
  EXPECT_LT((vertexAt(both, 0, both.clips[1].first + 4) - Vec3f(0, 2, 0)).norm(), 1e-6);
  const VertexAnimation up = animationOf(scene, {"up", 2.0});
  ASSERT_EQ(up.clips.size(), 1u);
  EXPECT_EQ(up.sequence.frameCount(), 5u);
}

TEST(VertexAnimation, WhatDoesNotMoveIsOfAKindThatThePageKnows) {
  const auto kindOf = [](SceneBuilder& scene) -> std::optional<ErrorKind> {
    try {
      animationOf(scene);
    } catch (const KnownError& error) {
      return error.kind();
    }
    return std::nullopt;
  };
  SceneBuilder bare = shownTetrahedron();
  EXPECT_EQ(kindOf(bare), ErrorKind::kNoAnimation);
  SceneBuilder still = shownTetrahedron();
  animate(still, "still", 0, "translation", {0, 1}, {1, 0, 0, 1, 0, 0});
  EXPECT_EQ(kindOf(still), ErrorKind::kNoAnimation);
}

}  // namespace
}  // namespace limber
