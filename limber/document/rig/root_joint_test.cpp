// A root joint above skeletons as exporters write them: what a viewer shows is the same before and after.
#include "limber/document/rig/root_joint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/skeleton/pose.h"

namespace limber {
namespace {

using ::testing::Contains;
using testing::SceneBuilder;
using testing::translation;

// An armature in centimetres that lies on its back, a body of two joints in it, a clip of the lower one.
struct Exported {
  SceneBuilder scene;
  Index mesh, chest, hips, body, armature, skin;

  explicit Exported(const Json& placement) {
    mesh = scene.addTetrahedron(Vec3f(0, 0.01f, 0), 0.5f);
    chest = scene.addNode({{"name", "chest"}, {"translation", {0, 0, 40}}});
    hips = scene.addNode({{"name", "hips"}, {"children", {chest}}, {"translation", {3, -2, 90}}});
    skin = scene.addSkin({hips, chest}, {translation(0.03, 0.02, -0.9), translation(0.03, 0.02, -1.3)});
    scene.bindRigidly(mesh, {0, 0, 1, 1});
    body = scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
    Json node = placement;
    node["name"] = "Armature";
    node["children"] = {hips};
    armature = scene.addNode(node);
    scene.addScene({armature, body});
    addKeys(hips);
  }

  void addKeys(Index node) {
    gltf::Animation& clip = scene.asset().document.animations.emplace_back();
    clip.name = "walk";
    const Index times = addFloatAccessor(scene.asset(), std::vector<float>{0, 1}, 1, 0, true);
    const auto add = [&](const char* path, const std::vector<float>& values, Index components, Interpolation kind) {
      const Index output = addFloatAccessor(scene.asset(), values, components);
      clip.samplers.push_back({{}, times, output, kind});
      clip.channels.push_back({{}, static_cast<Index>(clip.samplers.size() - 1), {{}, node, path}});
    };
    add("translation", {0, 0, 10, 3, -2, 90, 5, 0, 0, 0, 8, 0, 3, -90, 95, 0, 0, 0}, 3, Interpolation::kCubic);
    add("rotation", {0, 0, 0, 1, 0, 0.6f, 0, 0.8f}, 4, Interpolation::kLinear);
    add("scale", {1, 1, 1, 1, 1.5f, 1}, 3, Interpolation::kLinear);
  }
};

// The vertices in each clip at some times, by the skins' own matrices and the nodes' transforms.
std::vector<Vec3> shown(const Asset& asset) {
  std::vector<Vec3> result;
  const AssetSkeleton skeleton = animatedSkeleton(asset);
  Warnings warnings;
  const SceneGraph graph = readSceneGraph(asset.document);
  std::vector<Clip> clips = readClips(asset, skeleton, warnings);
  clips.emplace_back();
  for (const Clip& clip : clips) {
    for (const double time : {0.0, 0.3, 1.0}) {
      Pose pose;
      for (Index j = 0; j < skeleton.skeleton.jointCount(); ++j) {
        const Index node = skeleton.jointNode[j];
        pose.locals.push_back(decompose(skeleton.skeleton.joints[j].parent ? graph.local[node] : graph.world[node]));
      }
      sampleClip(clip, time, pose);
      const std::vector<Affine> globals = poseGlobals(skeleton.skeleton, pose);
      for (const gltf::Skin& skin : asset.document.skins) {
        const std::vector<float> binds = readFloats(asset, *skin.inverseBindMatrices);
        const std::vector<Vec3f> tetrahedron = SceneBuilder::tetrahedron(Vec3f(0, 0.01f, 0), 0.5f);
        for (std::size_t v = 0; v < 4; ++v) {
          const std::size_t joint = v / 2;
          const auto at = std::find(skeleton.jointNode.begin(), skeleton.jointNode.end(), skin.joints[joint]);
          Affine bind;
          bind.matrix() = Eigen::Map<const Eigen::Matrix4f>(binds.data() + 16 * joint).cast<double>();
          result.push_back(globals[at - skeleton.jointNode.begin()] * bind * tetrahedron[v].cast<double>());
        }
      }
    }
  }
  return result;
}

void expectSame(const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((before[i] - after[i]).norm(), 2e-6) << i;
}

const Json kBlender = {
    {"scale", {0.01, 0.01, 0.01}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}, {"translation", {0, 0.1, 0}}};

TEST(AddRootJoint, NothingMoves) {
  for (const Json& placement : {Json(Json::object()), kBlender}) {
    Exported exported(placement);
    Asset asset = exported.scene.build();
    const std::vector<Vec3> before = shown(asset);
    const AssetSkeleton skeleton = addRootJoint(asset);
    checkAsset(asset);
    expectSame(before, shown(asset));
    // At the origin, turned as the world.
    ASSERT_EQ(skeleton.skeleton.jointCount(), 3u);
    EXPECT_EQ(skeleton.skeleton.joints[0].name, "root");
    EXPECT_EQ(skeleton.skeleton.joints[1].parent, 0u);
    const Affine world = readSceneGraph(asset.document).world[skeleton.jointNode[0]];
    EXPECT_LT(world.translation().norm(), 1e-6);
    EXPECT_LT(decompose(world).rotation.angularDistance(Quat::Identity()), 1e-6);
    EXPECT_THAT(asset.document.skins[0].joints, Contains(skeleton.jointNode[0]));
    EXPECT_EQ(asset.document.skins[0].skeleton, skeleton.jointNode[0]);
    EXPECT_EQ(asset.document.nodes[exported.armature].children, (std::vector<Index>{skeleton.jointNode[0]}));
    // What is returned is what a reader finds.
    const AssetSkeleton read = animatedSkeleton(asset);
    for (Index j = 0; j < 3; ++j) {
      const auto at = std::find(read.jointNode.begin(), read.jointNode.end(), skeleton.jointNode[j]);
      ASSERT_NE(at, read.jointNode.end());
      const Joint& joint = read.skeleton.joints[at - read.jointNode.begin()];
      EXPECT_EQ(joint.name, skeleton.skeleton.joints[j].name);
      EXPECT_LT((joint.rest.translation - skeleton.skeleton.joints[j].rest.translation).norm(), 1e-4);
    }
  }
}

// Two characters in armatures of their own: the joint comes above both.
TEST(AddRootJoint, SeveralRoots) {
  Exported exported(kBlender);
  const Index mesh = exported.scene.addTetrahedron(Vec3f(0, 0.01f, 0), 0.5f);
  const Index head = exported.scene.addNode({{"name", "head"}, {"translation", {0, 1, 0}}});
  const Index tail = exported.scene.addNode({{"name", "root"}, {"children", {head}}, {"translation", {1, 0, 0}}});
  const Index skin = exported.scene.addSkin({tail, head}, {translation(-1, 0, 0), translation(-1, -1, 0)});
  exported.scene.bindRigidly(mesh, {0, 0, 1, 1});
  const Index body = exported.scene.addNode({{"name", "other"}, {"mesh", mesh}, {"skin", skin}});
  const Index above = exported.scene.addNode({{"children", {tail}}, {"translation", {0, 0, 2}}});
  for (const Index node : {above, body}) exported.scene.asset().document.scenes[0].nodes.push_back(node);
  exported.addKeys(tail);
  Asset asset = exported.scene.build();
  const std::vector<Vec3> before = shown(asset);
  const AssetSkeleton skeleton = addRootJoint(asset);
  checkAsset(asset);
  expectSame(before, shown(asset));
  EXPECT_EQ(skeleton.skeleton.joints[0].name, "root_2");
  EXPECT_TRUE(asset.warnings.empty());
  const auto isRoot = [](const Joint& joint) { return !joint.parent; };
  EXPECT_EQ(std::count_if(skeleton.skeleton.joints.begin(), skeleton.skeleton.joints.end(), isRoot), 1);
  EXPECT_THAT(asset.document.scenes[0].nodes, Contains(skeleton.jointNode[0]));
}

TEST(AddRootJoint, NotWhereThatWouldMoveSomething) {
  Exported exported(Json({{"scale", {1, 2, 1}}}));
  Asset asset = exported.scene.build();
  const std::vector<Vec3> before = shown(asset);
  addRootJoint(asset);  // one node's stretched frame is the root's, too
  expectSame(before, shown(asset));

  Exported flat(Json({{"scale", {0, 1, 1}}}));
  Asset without = flat.scene.build();
  EXPECT_THROW(addRootJoint(without), Error);
}

TEST(AddRootJoint, AboveASkeletonAlone) {
  Motion motion;
  motion.name = "pair";
  for (const char* name : {"left", "right"}) motion.skeleton.joints.emplace_back().name = name;
  Asset asset = motionAsset(motion);
  const AssetSkeleton skeleton = addRootJoint(asset, "ground");
  checkAsset(asset);
  EXPECT_EQ(skeleton.skeleton.joints[0].name, "ground");
  EXPECT_EQ(animatedSkeleton(asset).skeleton.jointCount(), 3u);
}

TEST(FindRootJoint, IsOnTheGroundAndCarriesNothing) {
  Exported exported(kBlender);
  Asset asset = exported.scene.build();
  EXPECT_FALSE(findRootJoint(asset, animatedSkeleton(asset)));  // the hips carry vertices
  addRootJoint(asset);
  const AssetSkeleton skeleton = animatedSkeleton(asset);
  const std::optional<Index> found = findRootJoint(asset, skeleton);
  ASSERT_TRUE(found);
  EXPECT_EQ(skeleton.skeleton.joints[*found].name, "root");
}

// A joint at the origin and one above it, between which the vertices' weights are divided.
Asset standing(float weightOfRoot) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index hips = scene.addNode({{"name", "hips"}, {"translation", {0, 1, 0}}});
  const Index own = scene.addNode({{"name", "root"}, {"children", {hips}}});
  const Index skin = scene.addSkin({own, hips}, {translation(0, 0, 0), translation(0, -1, 0)});
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  for (int v = 0; v < 4; ++v) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {weightOfRoot, 1 - weightOfRoot, 0, 0});
  }
  scene.bind(mesh, joints, weights);
  const Index body = scene.addNode({{"mesh", mesh}, {"skin", skin}});
  scene.addScene({own, body});
  return scene.build();
}

TEST(FindRootJoint, MayHaveALittleOfVertices) {
  for (const float weight : {0.1f, 0.5f}) {
    const Asset asset = standing(weight);
    EXPECT_EQ(findRootJoint(asset, animatedSkeleton(asset)), 0u) << weight;
  }
}

TEST(AddRootJoint, SaysWhereAnotherRootWas) {
  Asset asset = standing(0.9f);
  EXPECT_FALSE(findRootJoint(asset, animatedSkeleton(asset)));
  addRootJoint(asset);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "second-root");
  EXPECT_EQ(asset.warnings.items()[0].where, "root");
}

}  // namespace
}  // namespace limber
