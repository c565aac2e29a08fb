#include "limber/preview/animation.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/preview/testing/rigged_stool.h"
#include "limber/samples/samples.h"

namespace limber {
namespace {

// The root goes up by a metre within a second.
Clip rising() {
  Clip clip;
  clip.name = "rise";
  clip.translations.push_back({0, Interpolation::kLinear, {0, 1}, {Vec3f(0, 0, 0), Vec3f(0, 1, 0)}});
  return clip;
}

TEST(Animation, ShowsTheSceneAtAMomentOfAClip) {
  Asset asset = testing::riggedStool();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Clip clip = rising();
  const Vec3f rest = skeleton.skeleton.joints[0].rest.translation.cast<float>();
  for (Vec3f& value : clip.translations[0].values) value += rest;
  addClips(asset, skeleton, {&clip, 1});
  const Clip found = findClip(asset, "rise");
  const Scene still = makeScene(asset), begin = SceneMaker(asset).at(found, 0),
              later = SceneMaker(asset).at(found, 0.25);
  ASSERT_EQ(later.positions.size(), still.positions.size());
  for (std::size_t v = 0; v < still.positions.size(); ++v) {
    EXPECT_LT((begin.positions[v] - still.positions[v]).norm(), 1e-5f);
    EXPECT_LT((later.positions[v] - still.positions[v] - Vec3f(0, 0.25f, 0)).norm(), 1e-5f);
  }
  EXPECT_LT((later.joints[0].position - still.joints[0].position - Vec3(0, 0.25, 0)).norm(), 1e-6);
}

// A clip that moves blend shapes alone, of a model without joints.
TEST(Animation, ShowsBlendShapesAtAMoment) {
  Asset asset = makeSample("stool");
  const Geometry geometry = collectGeometry(asset);
  const PrimitiveInstance& first = geometry.instances.front();
  std::vector<float> offsets;
  for (Index v = 0; v < first.vertexCount; ++v) offsets.insert(offsets.end(), {0, 1, 0});
  gltf::Document& document = asset.document;
  document.meshes[first.mesh].primitives[first.primitive].targets.emplace_back().set(
      "POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
  const std::vector<float> times = {0, 2}, weights = {0, 1};
  const Index input = addFloatAccessor(asset, times, 1, 0, true), output = addFloatAccessor(asset, weights, 1);
  gltf::Animation& rise = document.animations.emplace_back();
  rise.name = "rise";
  rise.samplers.push_back({{}, input, output});
  rise.channels.push_back({{}, 0, {{}, first.node, "weights"}});
  const Clip found = findClip(asset, "rise");
  EXPECT_EQ(found.duration(), 0);
  EXPECT_EQ(SceneMaker(asset).duration(found), 2);
  const Scene still = makeScene(asset), later = SceneMaker(asset).at(found, 0.5);
  const Vec3 up = first.toWorld.linear() * Vec3(0, 0.25, 0);
  for (std::size_t v = first.firstVertex; v < first.firstVertex + first.vertexCount; ++v) {
    EXPECT_LT((later.positions[v] - still.positions[v] - up.cast<float>()).norm(), 1e-5f);
  }
}

TEST(Animation, BendsByTheDeformerThatIsAskedFor) {
  Asset asset = testing::riggedStool();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = restPose(skeleton.skeleton);
  pose.locals[1].rotation = Quat(Eigen::AngleAxisd(1.2, Vec3::UnitZ())) * pose.locals[1].rotation;
  writeNodePose(asset, skeleton, pose);
  const Deformer& mush = findDeformer("direct-delta-mush");
  const Scene plain = makeScene(asset), soft = SceneMaker(asset, mush).still();
  const AssetSkeleton posed = readSkeleton(asset);
  EXPECT_EQ(soft.positions, posedGeometry(asset, posed, readNodePose(asset, posed), mush).geometry.positions);
  EXPECT_NE(soft.positions, plain.positions);
  EXPECT_EQ(soft.triangles, plain.triangles);
}

TEST(Animation, ShowsASkeletonAloneAsItsBones) {
  Motion motion;
  motion.skeleton.joints.push_back({"hips", std::nullopt, {}, 0});
  Transform up;
  up.translation = Vec3(0, 2, 0);
  motion.skeleton.joints.push_back({"head", Index{0}, up, 0});
  motion.clips.push_back(rising());
  const Asset asset = motionAsset(motion);
  Box still, later;
  for (const Vec3f& p : makeScene(asset).positions) still.add(p.cast<double>());
  for (const Vec3f& p : SceneMaker(asset).at(findClip(asset, ""), 1).positions) later.add(p.cast<double>());
  EXPECT_GE(still.size().y(), 2);
  EXPECT_LT(still.size().x(), 1);
  EXPECT_LT((later.center() - still.center() - Vec3(0, 1, 0)).norm(), 1e-5);

  PreviewOptions options;
  Warnings warnings;
  Progress progress;
  options.width = options.height = 64;
  const std::vector<double> moments = clipMoments(motion.clips[0].duration(), 3, true);
  const std::vector<Image> images =
      renderClip(SceneMaker(asset), motion.clips[0], moments, options, progress, warnings);
  ASSERT_EQ(images.size(), 3u);
  EXPECT_NE(images[0].pixels, images[2].pixels);
  EXPECT_EQ(renderClip(SceneMaker(asset), motion.clips[0], moments, options, progress, warnings)[1].pixels,
            images[1].pixels);

  progress.cancel();
  EXPECT_THROW(renderClip(SceneMaker(asset), motion.clips[0], moments, options, progress, warnings), Error);
}

// Each joint's sphere has hundreds of triangles.
TEST(Animation, ManyJointsAreBonesAlone) {
  Motion motion;
  motion.skeleton.joints.push_back({"root", std::nullopt, {}, 0});
  Transform along;
  along.translation = Vec3(0, 0.1, 0.05);
  for (Index j = 1; j < 5000; ++j)
    motion.skeleton.joints.push_back({std::string("j").append(std::to_string(j)), j - 1, along, 0});
  motion.clips.push_back(rising());
  EXPECT_LE(makeScene(motionAsset(motion)).triangles.size(), 8u * 5000);
}

// A long thing off the origin: as wide as it is seen from its side, the picture holds it from everywhere.
TEST(Animation, ATurnHoldsTheModelFromAllAround) {
  Scene scene;
  scene.positions = {{10, 0, 0}, {14, 0, 0}, {14, 1, 0}, {10, 1, 0}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  PreviewOptions options;
  options.width = options.height = 64;
  options.view = {0, 0};
  options.backdrop.kind = Backdrop::Kind::kTransparent;
  Progress progress;
  const std::vector<Image> images = renderTurn(scene, options, 8, progress);
  ASSERT_EQ(images.size(), 8u);
  std::vector<int> widths;
  for (const Image& image : images) {
    int first = 64, last = -1;
    for (int x = 0; x < 64; ++x) {
      if (image.pixels[(std::size_t{30} * 64 + std::size_t(x)) * 4 + 3] == 0) continue;
      first = std::min(first, x);
      last = std::max(last, x);
    }
    if (last >= 0) {
      EXPECT_GT(first, 0);
      EXPECT_LT(last, 63);
    }
    widths.push_back(last - first);
  }
  EXPECT_GT(widths[0], 40);
  EXPECT_LT(widths[2], 10);  // from its narrow end
  EXPECT_NEAR(widths[4], widths[0], 1);
  EXPECT_THROW(renderTurn(scene, options, 0, progress), Error);
}

TEST(Animation, MomentsCoverTheClip) {
  const Clip clip = rising();
  EXPECT_EQ(clipMoments(clip.duration(), 5, true), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(clipMoments(clip.duration(), 4, false), (std::vector<double>{0, 0.25, 0.5, 0.75}));
  EXPECT_EQ(clipMoments(clip.duration(), 1, true), std::vector<double>{0});
  EXPECT_THROW(clipMoments(clip.duration(), 0, true), Error);
}

}  // namespace
}  // namespace limber
