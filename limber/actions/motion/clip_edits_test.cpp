// Clips made ready for engines, end to end: what a written file shows, against the file before.
#include "limber/actions/motion/clip_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/write.h"
#include "limber/skeleton/pose.h"
#include "shared_data.h"

namespace limber {
namespace {

// A model as its file has it.
struct Shown {
  AssetSkeleton skeleton;
  std::vector<Clip> clips;
  Geometry geometry;
  SkinWeights weights;
  double size = 0;

  explicit Shown(const Asset& asset) : skeleton(animatedSkeleton(asset)), geometry(collectGeometry(asset)) {
    Warnings warnings;
    clips = readClips(asset, skeleton, warnings);
    weights = readWeights(asset, geometry, skeleton);
    Box box;
    for (const Vec3f& position : geometry.positions) box.add(position.cast<double>());
    size = box.diagonal();
  }

  // Of every `stride`th vertex.
  std::vector<Vec3> surface(std::size_t clip, double time, std::size_t stride) const {
    Pose pose = restPose(skeleton.skeleton);
    sampleClip(clips[clip], time, pose);
    const std::vector<Affine> skin = skinTransforms(skeleton.skeleton, pose);
    std::vector<Vec3> result;
    for (std::size_t v = 0; v < geometry.positions.size(); v += stride) {
      Vec3 point = Vec3::Zero();
      for (Index s = 0; s < weights.slots; ++s) {
        point += weights.weightsOf(v)[s] * (skin[weights.jointsOf(v)[s]] * geometry.positions[v].cast<double>());
      }
      result.push_back(point);
    }
    return result;
  }
};

double farthest(const Shown& a, const Shown& b) {
  double worst = 0;
  const std::size_t stride = a.geometry.positions.size() / 500 + 1;
  for (std::size_t clip = 0; clip < a.clips.size(); ++clip) {
    for (int k = 0; k <= 60; ++k) {
      const double time = a.clips[clip].duration() * k / 60.0;
      const auto one = a.surface(clip, time, stride), other = b.surface(clip, time, stride);
      for (std::size_t v = 0; v < one.size(); ++v) worst = std::max(worst, (one[v] - other[v]).norm());
    }
  }
  return worst;
}

class SharedCharacters : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto folder = testing::sharedDataFolder();
    if (!folder) GTEST_SKIP() << testing::kNoSharedData;
    asset_ = readAsset(*folder / "rigged" / GetParam());
    for (std::size_t a = 0; a < asset_.document.animations.size(); ++a) {
      names_.push_back(asset_.document.animations[a].name = "clip" + std::to_string(a));
      if (names_.size() == 2) break;
    }
    asset_.document.animations.resize(names_.size());
  }

  Asset asset_;
  std::vector<std::string> names_;
};

TEST_P(SharedCharacters, ARootJointMovesNoVertex) {
  const Shown before(asset_);
  ClipEdits edits;
  edits.rootJoint = "root";
  edits.heading = true;
  editClips(asset_, names_, edits);
  const Asset written = readAsset(writeGlb(asset_), "written.glb");
  EXPECT_LT(farthest(before, Shown(written)), 2e-6 * before.size);
}

TEST_P(SharedCharacters, FewerKeysStayWithinTheTolerance) {
  const Shown before(asset_);
  const std::size_t bytes = writeGlb(asset_).size();
  for (const double part : {0.0005, 0.005}) {
    Asset asset = asset_.clone();
    ClipEdits edits;
    edits.tolerance = part * before.size;
    const std::vector<ClipEditReport> reports = editClips(asset, names_, edits);
    const Bytes file = writeGlb(asset);
    EXPECT_LT(farthest(before, Shown(readAsset(file, "written.glb"))), *edits.tolerance);
    EXPECT_LT(static_cast<double>(file.size()), 1.1 * static_cast<double>(bytes));  // one file is reduced already
    for (const ClipEditReport& report : reports) EXPECT_LE(report.keysAfter, report.keysBefore);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SharedCharacters,
                         ::testing::Values("cesium_man.glb", "fox_khronos.glb", "quaternius_horse.glb",
                                           "robot_expressive.glb"));

// A root that walks, and an arm.
Motion walking() {
  Motion motion;
  motion.name = "walking";
  for (const char* name : {"hips", "spine", "head"}) {
    Joint joint;
    joint.name = name;
    if (!motion.skeleton.joints.empty()) joint.parent = motion.skeleton.jointCount() - 1;
    joint.rest.translation = {0, motion.skeleton.joints.empty() ? 1.0 : 0.4, 0};
    motion.skeleton.joints.push_back(joint);
  }
  Track<Vec3f> path{0, Interpolation::kLinear, {}, {}};
  Track<Eigen::Quaternionf> nods{1, Interpolation::kLinear, {}, {}};
  for (int k = 0; k <= 90; ++k) {
    const float time = k / 30.0f;
    path.times.push_back(time);
    path.values.emplace_back(0.0f, 1.0f, 1.3f * time);
    nods.values.emplace_back(Eigen::AngleAxisf(0.3f * std::sin(6.2831853f * time), Vec3f::UnitX()));
  }
  nods.times = path.times;
  Clip clip;
  clip.name = "walk";
  clip.translations = {path};
  clip.rotations = {nods};
  motion.clips = {clip};
  return motion;
}

TEST(EditClips, InTheOrderStated) {
  Motion motion = walking();
  ClipEdits edits;
  edits.loop = edits.inPlace = true;
  edits.frameRate = 10;
  const std::vector<ClipEditReport> reports = editClips(motion, edits);
  ASSERT_EQ(reports.size(), 1u);
  ASSERT_TRUE(reports[0].loop);
  const Clip& clip = motion.clips[0];
  const double rounds = clip.duration();
  EXPECT_NEAR(rounds, std::round(rounds), 0.04);  // nods a second
  const auto& path = clip.translations[0];
  EXPECT_LT((path.values.front() - path.values.back()).norm(), 1e-5f);
  EXPECT_NEAR(path.values.front().z(), 0, 0.1);
  EXPECT_LE(path.times.size(), 10 * rounds + 2);
}

TEST(EditClips, AMotionGetsARootJoint) {
  Motion motion = walking();
  ClipEdits edits;
  edits.rootJoint = "ground";
  editClips(motion, edits);
  checkMotion(motion);
  EXPECT_EQ(motion.skeleton.joints[0].name, "ground");
  EXPECT_EQ(motion.skeleton.joints[1].parent, 0u);
  Pose pose = restPose(motion.skeleton);
  sampleClip(motion.clips[0], 3, pose);
  EXPECT_NEAR(pose.locals[0].translation.z(), 3.9, 1e-4);
  EXPECT_NEAR(posePositions(motion.skeleton, pose)[1].z(), 3.9, 1e-4);
}

TEST(EditClips, AModelsOwnRootTakesTheTravelOfVerticesThatFollowItInPart) {
  testing::SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index hips = scene.addNode({{"name", "hips"}, {"translation", {0, 1, 0}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {hips}}});
  const Index skin = scene.addSkin({root, hips}, {});
  scene.bind(mesh, {0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
             {0.1f, 0.9f, 0, 0, 0.2f, 0.8f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  scene.addScene({root, scene.addNode({{"mesh", mesh}, {"skin", skin}})});
  scene.addClip(hips, "translation", 3);
  Asset asset = scene.build();
  asset.document.animations[0].name = "walk";
  ClipEdits edits;
  edits.rootJoint = "mover";
  editClips(asset, std::vector<std::string>{"walk"}, edits);
  EXPECT_EQ(animatedSkeleton(asset).skeleton.jointCount(), 2u);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "root-weights");
  EXPECT_EQ(asset.warnings.items()[0].count, 2u);
}

TEST(EditClips, OthersStay) {
  Asset asset = motionAsset(walking());
  asset.document.animations.push_back(asset.document.animations[0]);
  asset.document.animations[1].name = "other";
  ClipEdits edits;
  edits.inPlace = true;
  editClips(asset, std::vector<std::string>{"walk"}, edits);
  checkAsset(asset);
  const Motion after = motionOf(asset);
  ASSERT_EQ(after.clips.size(), 2u);
  EXPECT_EQ(after.clips[0].name, "walk");
  EXPECT_NEAR(after.clips[0].translations[0].values.back().z(), 0, 1e-3);
  EXPECT_NEAR(after.clips[1].translations[0].values.back().z(), 3.9, 1e-4);
  EXPECT_THROW(editClips(asset, std::vector<std::string>{"run"}, edits), Error);
}

// How far the joint goes from the clip's beginning to its end.
Vec3 travelOf(const Motion& motion, const std::string& joint) {
  const Index number = motion.skeleton.find(joint).value();
  const auto at = [&](double seconds) {
    Pose pose = restPose(motion.skeleton);
    sampleClip(motion.clips.at(0), seconds, pose);
    return Vec3(poseGlobals(motion.skeleton, pose)[number].translation());
  };
  return at(motion.clips[0].duration()) - at(0);
}

TEST(EditClips, TheMovementOfAnArmatureIsThereOnce) {
  Asset moving = motionAsset(walking());
  gltf::Document& document = moving.document;
  gltf::Node armature;
  armature.name = "armature";
  armature.children = document.scenes.at(0).nodes;
  const Index node = addElement(document.nodes, std::move(armature));
  document.scenes[0].nodes = {node};
  const auto end = static_cast<float>(motionOf(moving).clips.at(0).duration());
  gltf::Animation& walk = document.animations[0];
  gltf::AnimationSampler sampler;
  sampler.input = addFloatAccessor(moving, std::vector<float>{0, end}, 1, 0, true);
  sampler.output = addFloatAccessor(moving, std::vector<float>{0, 0, 0, 3, 0, 0}, 3);
  walk.channels.push_back({{}, addElement(walk.samplers, std::move(sampler)), {{}, node, "translation"}});
  checkAsset(moving);
  const std::string body = motionOf(moving).skeleton.joints[0].name;
  const Vec3 travel = travelOf(motionOf(moving), body);
  ASSERT_NEAR(travel.x(), 3, 1e-4);
  ClipEdits resampled, rooted, reduced, inPlace;
  resampled.frameRate = 30;
  rooted.rootJoint = "mover";
  reduced.tolerance = 1e-4;
  inPlace.inPlace = true;
  for (const ClipEdits& edits : {resampled, rooted, reduced, inPlace}) {
    Asset asset = moving.clone();
    editClips(asset, std::vector<std::string>{"walk"}, edits);
    checkAsset(asset);
    const Vec3 after = travelOf(motionOf(asset), body), wanted = edits.inPlace ? Vec3(0, travel.y(), 0) : travel;
    EXPECT_LT((after - wanted).norm(), 2e-3) << after.transpose();
  }
}

TEST(EditClips, ALoopCutsWhatElseMovesAndJoinsWeights) {
  Asset asset = motionAsset(walking());
  const std::vector<float> times = {0, 3}, values = {0, 0, 0, 3, 0, 0};
  gltf::Animation& walk = asset.document.animations[0];
  walk.channels.push_back({});
  walk.channels.back().target.node = addElement(asset.document.nodes, gltf::Node());
  walk.channels.back().target.path = "translation";
  walk.channels.back().sampler = static_cast<Index>(walk.samplers.size());
  walk.samplers.push_back({});
  walk.samplers.back().input = addFloatAccessor(asset, times, 1);
  walk.samplers.back().output = addFloatAccessor(asset, values, 3);
  // Three weights of blend shapes of the same numbers.
  walk.samplers.push_back(walk.samplers.back());
  walk.channels.push_back(walk.channels.back());
  walk.channels.back().target.path = "weights";
  ++walk.channels.back().sampler;
  ClipEdits edits;
  edits.loop = true;
  const std::vector<ClipEditReport> reports = editClips(asset, std::vector<std::string>{"walk"}, edits);
  ASSERT_TRUE(reports[0].loop);
  const gltf::AnimationSampler& kept = asset.document.animations[0].samplers[0];
  EXPECT_NEAR(readFloats(asset, kept.input).back(), reports[0].loop->end - reports[0].loop->begin, 1e-5);
  EXPECT_NEAR(readFloats(asset, kept.output)[0], reports[0].loop->begin, 1e-5);
  const std::vector<float> weights = readFloats(asset, asset.document.animations[0].samplers[1].output);
  EXPECT_NEAR(weights[0], 0.5 * (reports[0].loop->begin + reports[0].loop->end), 1e-5);
  EXPECT_EQ(weights[0], weights[weights.size() - 3]);
}

}  // namespace
}  // namespace limber
