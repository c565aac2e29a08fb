#include "limber/document/clip/motion_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/write.h"
#include "shared_data.h"
#include "temporary_folder.h"
#include "warning_kinds.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

const std::string kBvh =
    "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\nJOINT Spine\n{\nOFFSET 0 0.5 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 0.3 "
    "0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.05\n0 1 0 0 0 0 10 0 0\n0 1 1 0 5 0 20 0 0\n0 1 2 0 10 0 30 0 0\n";

double largestDistanceAt(const Motion& a, const Motion& b, double seconds) {
  Pose poseA = restPose(a.skeleton), poseB = restPose(b.skeleton);
  sampleClip(a.clips.at(0), seconds, poseA);
  sampleClip(b.clips.at(0), seconds, poseB);
  const std::vector<Affine> x = poseGlobals(a.skeleton, poseA), y = poseGlobals(b.skeleton, poseB);
  double largest = 0;
  for (Index j = 0; j < a.skeleton.jointCount(); ++j) {
    const std::optional<Index> other = b.skeleton.find(a.skeleton.joints[j].name);
    if (!other) return HUGE_VAL;
    largest = std::max(largest, (x[j].translation() - y[*other].translation()).norm());
  }
  return largest;
}

TEST(MotionIo, BvhComesOutOfGltfAsItWentIn) {
  const Motion motion = readMotion(asBytes(kBvh), "walk.bvh");
  const Bytes glb = writeGlb(motionAsset(motion));
  writeFile(limber::testing::testOutputFolder() / "motion_io_bvh.glb", glb);
  const Motion back = readMotion(glb, "walk.glb");
  EXPECT_EQ(back.name, "walk");
  EXPECT_EQ(back.framesPerSecond, 20);
  ASSERT_EQ(back.skeleton.joints.size(), 3u);
  EXPECT_EQ(back.skeleton.joints[2].name, "Spine_end");
  for (const double seconds : {0.0, 0.02, 0.07, 0.1}) EXPECT_LT(largestDistanceAt(motion, back, seconds), 1e-6);
}

TEST(MotionIo, JointsKeepTheBonesThatTheirFileDeclares) {
  Motion motion = readMotion(asBytes(kBvh), "walk.bvh");
  for (const bool hasSkin : {true, false}) {
    Asset asset = motionAsset(motion);
    if (!hasSkin) asset.document.skins.clear();
    changeExtension(asset.document, "VRM") = {
        {"humanoid", {{"humanBones", {{{"bone", "hips"}, {"node", 0}}, {{"bone", "spine"}, {"node", 1}}}}}}};
    const Skeleton skeleton = animatedSkeleton(asset).skeleton;
    EXPECT_EQ(skeleton.joints.at(0).declaredBone, "hips");
    EXPECT_EQ(skeleton.joints.at(1).declaredBone, "spine");
    EXPECT_EQ(skeleton.joints.at(2).declaredBone, "");
  }
}

TEST(MotionIo, FindsClipsByName) {
  Motion motion = readMotion(asBytes(kBvh), "walk.bvh");
  motion.clips.push_back(motion.clips[0]);
  motion.clips[1].name = "Armature|run";
  motion.clips.push_back(motion.clips[0]);
  motion.clips[2].name = "run";
  const Asset asset = motionAsset(motion);
  EXPECT_EQ(findClip(asset, "").name, "walk");
  EXPECT_EQ(findClip(asset, "Armature|run").name, "Armature|run");
  EXPECT_EQ(findClip(asset, "run").name, "run") << "the full name comes first";
  motion.clips.pop_back();
  EXPECT_EQ(findClip(motionAsset(motion), "run").name, "Armature|run");
  try {
    findClip(asset, "fall");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("there are: walk, Armature|run, run"));
  }
  motion.clips.clear();
  EXPECT_EQ(findClip(motionAsset(motion), "").duration(), 0);
}

TEST(MotionIo, BlendShapesAloneMoveNoJoint) {
  testing::SceneBuilder scene;
  const Index node = scene.addNode({{"mesh", scene.addTetrahedron()}});
  scene.addScene({node});
  scene.addClip(node, "weights", 1);
  const Asset asset = std::move(scene.asset());
  const Motion motion = motionOf(asset, movingSkeleton(asset));
  EXPECT_TRUE(motion.skeleton.joints.empty());
  ASSERT_EQ(motion.clips.size(), 1u);
  EXPECT_TRUE(motion.clips[0].rotations.empty());
  EXPECT_THROW(motionOf(asset), Error);
}

TEST(MotionIo, AMotionAloneLosesItsBlendShapes) {
  limber::testing::GltfBuilder model = limber::testing::everythingModel();
  EXPECT_EQ(limber::testing::countOf(readMotion(model.glb(), "turn.glb").warnings, "motion-shapes"), 0u);
  const Index times = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  const Index weights = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  model.json["animations"][0]["samplers"].push_back({{"input", times}, {"output", weights}});
  model.json["animations"][0]["channels"].push_back({{"sampler", 1}, {"target", {{"node", 2}, {"path", "weights"}}}});
  const Motion motion = readMotion(model.glb(), "turn.glb");
  EXPECT_EQ(limber::testing::countOf(motion.warnings, "motion-shapes"), 1u);
  for (const Warning& warning : motion.warnings.items()) {
    if (warning.kind == "motion-shapes") {
      EXPECT_EQ(warning.where, "turn");
    }
  }
  ASSERT_EQ(motion.clips.size(), 1u);
  EXPECT_EQ(motion.clips[0].rotations.size(), 1u) << "the joint moves all the same";
}

TEST(MotionIo, ABvhIsAModelToo) {
  const Asset asset = readAsset(asBytes(kBvh), "walk.bvh");
  EXPECT_EQ(asset.format, "bvh");
  EXPECT_EQ(asset.document.animations.size(), 1u);
  EXPECT_EQ(asset.document.animations[0].name, "walk");
  try {
    readAsset(asBytes("HIERARCHY\nROOT\n"), "walk.bvh");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("walk.bvh: line "));
  }
}

TEST(MotionIo, SeveralRootsHangOnOneNode) {
  const std::string root = "ROOT a\n{\nOFFSET 1 2 3\nCHANNELS 1 Xrotation\n}\n";
  const Motion motion =
      readMotion(asBytes("HIERARCHY\n" + root + root + "MOTION\nFrames: 2\nFrame Time: 1\n1 2\n3 4\n"), "two.bvh");
  const Asset asset = motionAsset(motion);
  checkAsset(asset);
  EXPECT_EQ(asset.document.scenes[0].nodes.size(), 1u);
  writeAsset(asset, limber::testing::testOutputFolder() / "motion_io_two_roots.glb");
  const Motion back = motionOf(asset);
  EXPECT_LT(largestDistanceAt(motion, back, 0.5), 1e-6);
}

TEST(MotionIo, NodesThatMoveAreJointsWhereThereIsNoSkin) {
  limber::testing::GltfBuilder model;
  const Index times = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  const Index turns = model.accessor<float>({0, 0, 0, 1, 0, 0, 1, 0}, 5126, "VEC4", 2);
  model.push("nodes", {{"name", "stage"}, {"children", {1, 5}}, {"scale", {2.0, 2.0, 2.0}}});
  model.push("nodes", {{"name", "hips"}, {"children", {2, 4}}, {"translation", {0.0, 1.0, 0.0}}});
  model.push("nodes", {{"name", "spine"}, {"children", {3}}, {"translation", {0.0, 1.0, 0.0}}});
  model.push("nodes", {{"name", "tip"}, {"translation", {0.0, 1.0, 0.0}}});
  model.push("nodes", {{"name", "lamp"}, {"camera", 0}});
  model.push("nodes", {{"name", "floor"}});
  model.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
  model.push("scenes", {{"nodes", {0}}});
  const auto channel = [](int node) {
    return Json{{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}};
  };
  model.push("animations", {{"samplers", Json::array({{{"input", times}, {"output", turns}}})},
                            {"channels", Json::array({channel(1), channel(2)})}});
  const Motion motion = readMotion(model.glb(), "tree.glb");
  ASSERT_EQ(motion.skeleton.joints.size(), 3u);
  EXPECT_EQ(motion.skeleton.joints[0].name, "hips");
  EXPECT_EQ(motion.skeleton.joints[1].name, "spine");
  EXPECT_EQ(motion.skeleton.joints[2].name, "tip");
  Pose pose = restPose(motion.skeleton);
  sampleClip(motion.clips.at(0), 1, pose);  // both turned by half a turn about Z
  const std::vector<Affine> globals = poseGlobals(motion.skeleton, pose);
  EXPECT_LT((globals[0].translation() - Vec3(0, 2, 0)).norm(), 1e-6);
  EXPECT_LT((globals[1].translation() - Vec3(0, 0, 0)).norm(), 1e-6);
  EXPECT_LT((globals[2].translation() - Vec3(0, 2, 0)).norm(), 1e-6);
}

TEST(MotionIo, BareNodesAreASkeletonWhereThereIsNothingElse) {
  limber::testing::GltfBuilder model;
  model.push("nodes", {{"name", "hips"}, {"children", {1, 2}}, {"translation", {0.0, 1.0, 0.0}}});
  model.push("nodes", {{"name", "spine"}, {"translation", {0.0, 1.0, 0.0}}});
  model.push("nodes", {{"name", "lamp"}, {"camera", 0}});
  model.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
  model.push("scenes", {{"nodes", {0}}});
  const Motion still = readMotion(model.glb(), "still.glb");
  ASSERT_EQ(still.skeleton.joints.size(), 2u);
  EXPECT_EQ(still.skeleton.joints[1].name, "spine");
  EXPECT_EQ(still.skeleton.joints[1].parent, Index{0});
  EXPECT_TRUE(still.clips.empty());
}

TEST(MotionIo, RefusesAFileWithNothingThatMoves) {
  limber::testing::GltfBuilder model;
  model.push("nodes", {{"name", "alone"}});
  model.push("scenes", {{"nodes", {0}}});
  EXPECT_THROW(readMotion(model.glb(), "still.glb"), Error);
  EXPECT_THROW(motionAsset(Motion()), Error);
}

TEST(MotionIo, ReadsEverySharedMotion) {
  const std::optional<fs::path> data = limber::testing::sharedDataFolder();
  if (!data) GTEST_SKIP() << limber::testing::kNoSharedData;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(*data / "motions")) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".asf" || extension == ".amc") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Motion motion = readMotion(entry.path());
    EXPECT_NO_THROW(checkMotion(motion));
    EXPECT_FALSE(motion.clips.empty());
    EXPECT_GT(motion.skeleton.joints.size(), 1u);
    ++count;
    if (extension != ".bvh" || fs::file_size(entry.path()) > 500000) continue;
    const Motion back = readMotion(writeGlb(motionAsset(motion)), "back.glb");
    for (const double part : {0.0, 0.3, 1.0}) {
      const double seconds = part * motion.clips[0].duration();
      EXPECT_LT(largestDistanceAt(motion, back, seconds), 1e-4);
    }
  }
  EXPECT_GE(count, 40u);
}

}  // namespace
}  // namespace limber
