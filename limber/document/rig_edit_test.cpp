// removeRig and replaceWeights.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/gltf/extensions.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

using ::testing::Contains;
using testing::documentJson;
using testing::editDocument;
using testing::SceneBuilder;
using testing::translation;

// A character as Blender writes it: an armature with a transform, hips with a chest and an end site, a skinned body
// beside them, a hat attached to the chest, a camera on the hips, clips of the chest and of a separate lamp.
struct EditedCharacter {
  SceneBuilder scene;
  Index bodyMesh, hatMesh, end, hat, chest, camera, hip, body, armature, lamp, skin;

  EditedCharacter() {
    bodyMesh = scene.addTetrahedron();
    hatMesh = scene.addTetrahedron(Vec3f::Zero(), 0.5f);
    end = scene.addNode({{"name", "chest_end"}, {"translation", {0, 1, 0}}});
    hat = scene.addNode({{"name", "hat"}, {"mesh", hatMesh}, {"translation", {0, 0.5, 0}}});
    chest = scene.addNode({{"name", "chest"}, {"children", {end, hat}}, {"translation", {0, 1, 0}}});
    camera = scene.addNode({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 3}}});
    hip = scene.addNode({{"name", "hip"}, {"children", {chest, camera}}, {"translation", {0, 2, 0}}});
    skin = scene.addSkin({hip, chest}, {translation(0, -2, 0), translation(0, -3, 0)});
    scene.bindRigidly(bodyMesh, {0, 0, 1, 1});
    body = scene.addNode({{"name", "body"}, {"mesh", bodyMesh}, {"skin", skin}});
    armature = scene.addNode(
        {{"name", "Armature"}, {"children", {hip, body}}, {"scale", {0.5, 0.5, 0.5}}, {"translation", {7, 0, 0}}});
    lamp = scene.addNode({{"name", "lamp"}});
    scene.addScene({armature, lamp});
    editDocument(scene.asset(), [](Json& json) {
      json["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}});
    });
    scene.addClip(chest, "rotation", 4);
    scene.addClip(lamp, "translation", 3);
  }
};

Index nodeNamed(const Asset& asset, const std::string& name) {
  for (Index n = 0; n < asset.document.nodeCount(); ++n) {
    if (asset.document.nodes[n].name == name) return n;
  }
  ADD_FAILURE() << "no node " << name;
  return 0;
}

void expectSamePositions(const Geometry& a, const Geometry& b, float tolerance = 1e-5f) {
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t v = 0; v < a.positions.size(); ++v) {
    EXPECT_LT((a.positions[v] - b.positions[v]).norm(), tolerance) << v;
  }
  EXPECT_EQ(a.triangles, b.triangles);
}

// --- removeRig ---

TEST(RemoveRig, LeavesTheModelWhereItStood) {
  EditedCharacter character;
  Asset asset = character.scene.build();
  const Geometry before = collectGeometry(asset);
  removeRig(asset);
  checkAsset(asset);
  EXPECT_FALSE(hasRig(asset));
  EXPECT_FALSE(documentJson(asset).contains("skins"));
  expectSamePositions(before, collectGeometry(asset));
}

TEST(RemoveRig, LeavesAPosedModelInItsBindPose) {
  EditedCharacter character;
  character.scene.node(character.chest).rotation = Vec4(0, 0, 1, 0);
  character.scene.node(character.chest).translation = Vec3(3, 3, 3);
  Asset asset = character.scene.build();
  const Geometry before = collectGeometry(asset);
  removeRig(asset);
  expectSamePositions(before, collectGeometry(asset));
}

TEST(RemoveRig, TakesJointsOutThatHoldNothing) {
  EditedCharacter character;
  Asset asset = character.scene.build();
  const Affine eyeBefore = readSceneGraph(asset.document).world[character.camera];
  removeRig(asset);
  std::vector<std::string> names;
  for (const gltf::Node& node : asset.document.nodes) names.push_back(node.name);
  // chest and hip stay: the hat and the camera hang on them.
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("hat", "chest", "eye", "hip", "body", "Armature", "lamp"));
  EXPECT_TRUE(readSceneGraph(asset.document).world[nodeNamed(asset, "eye")].isApprox(eyeBefore, 1e-6));
  EXPECT_EQ(documentJson(asset)["nodes"][nodeNamed(asset, "lamp")], Json({{"name", "lamp"}}));
}

TEST(RemoveRig, TakesAnArmatureOutThatHeldOnlyJoints) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index tip = scene.addNode({{"name", "tip"}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}});
  const Index armature = scene.addNode({{"name", "Armature"}, {"children", {root}}});
  const Index skin = scene.addSkin({root, tip}, {Affine::Identity(), Affine::Identity()});
  scene.bindRigidly(mesh, {0, 0, 1, 1});
  const Index body = scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
  scene.addScene({armature, body});
  Asset asset = scene.build();
  removeRig(asset);
  EXPECT_EQ(documentJson(asset)["nodes"], Json::array({{{"name", "body"}, {"mesh", mesh}}}));
  EXPECT_EQ(asset.document.scenes[0].nodes, std::vector<Index>{0});
}

TEST(RemoveRig, TakesTheMovementOfJointsOutAndNoOther) {
  EditedCharacter character;
  gltf::Animation& both = character.scene.asset().document.animations[1];
  both.name = "swing";
  // A clip that moves both: its channel of the chest goes, and only that sampler.
  both.channels.insert(both.channels.begin(), {{}, 1, {{}, character.hip, "translation"}});
  both.samplers.push_back(both.samplers[0]);
  both.channels[1].sampler = 0;
  both.samplers[0].interpolation = Interpolation::kStep;
  Asset asset = character.scene.build();
  removeRig(asset);
  checkAsset(asset);
  const std::vector<gltf::Animation>& animations = asset.document.animations;
  ASSERT_EQ(animations.size(), 1u);
  EXPECT_EQ(animations[0].name, "swing");
  ASSERT_EQ(animations[0].channels.size(), 1u);
  EXPECT_EQ(animations[0].channels[0].target.node, nodeNamed(asset, "lamp"));
  ASSERT_EQ(animations[0].samplers.size(), 1u);
  EXPECT_EQ(animations[0].samplers[0].interpolation, Interpolation::kStep);
}

// Two joints, and all vertices on the first.
void attachSimply(Asset& asset) {
  const Geometry geometry = collectGeometry(asset);
  Skeleton skeleton;
  skeleton.boneShape = BoneShape::kSphere;
  for (const char* name : {"a", "b"}) {
    Joint joint;
    joint.name = name;
    if (!skeleton.joints.empty()) joint.parent = 0;
    joint.rest.translation = Vec3(0.3, 0.7, -0.1);
    skeleton.joints.push_back(joint);
  }
  SkinWeights weights;
  weights.slots = 1;
  weights.joints.assign(geometry.positions.size(), 0);
  weights.weights.assign(geometry.positions.size(), 1.0f);
  attachRig(asset, geometry, skeleton, weights);
}

TEST(RemoveRig, UndoesAttachRig) {
  SceneBuilder scene;
  Json primitive = scene.primitive(SceneBuilder::tetrahedron(), SceneBuilder::tetrahedronTriangles());
  scene.addNode({{"name", "body"}, {"mesh", scene.addMesh(Json::array({primitive}))}, {"extras", {{"kept", 1}}}});
  scene.addNode({{"name", "lamp"}});
  scene.addNode({{"name", "tail"}, {"mesh", scene.addTetrahedron()}, {"translation", {1, 2, 3}}, {"weights", {0.5}}});
  scene.addNode({{"name", "stand"}, {"children", {2}}, {"scale", {0.1, 0.2, 0.3}}});
  scene.addScene({0, 1, 3});
  scene.addClip(2, "weights", 1);
  Asset asset = std::move(scene.asset());
  const Json before = documentJson(asset);
  for (int round = 0; round < 3; ++round) {
    attachSimply(asset);
    EXPECT_TRUE(hasRig(asset));
    EXPECT_NE(documentJson(asset)["nodes"], before["nodes"]);
    removeRig(asset);
    const Json after = documentJson(asset);
    for (const char* key : {"nodes", "scenes", "animations"}) {
      EXPECT_EQ(nlohmann::json(after[key]), nlohmann::json(before[key])) << key;  // whatever the order of members
    }
    EXPECT_EQ(after["meshes"][0]["primitives"], before["meshes"][0]["primitives"]);
    EXPECT_FALSE(after.contains("skins"));
  }
}

TEST(RemoveRig, WithoutASkinDoesNothing) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  Asset asset = scene.build();
  const Json before = documentJson(asset);
  removeRig(asset);
  EXPECT_EQ(documentJson(asset), before);
}

TEST(RemoveRig, AccessorsOfTheRigGoAndTheirBytesStay) {
  EditedCharacter character;
  Asset asset = character.scene.build();
  const Json before = documentJson(asset);
  const Bytes bytes = asset.buffers[0].bytes;
  const auto hatPositions = [&] {
    return readFloats(asset, *asset.document.meshes[character.hatMesh].primitives[0].attributes.find("POSITION"));
  };
  const std::vector<float> hat = hatPositions();
  removeRig(asset);
  // Inverse binds, joints, weights, and the two accessors of the chest's clip.
  EXPECT_EQ(asset.document.accessors.size(), before["accessors"].size() - 5);
  EXPECT_EQ(documentJson(asset)["bufferViews"], before["bufferViews"]);
  EXPECT_EQ(asset.buffers[0].bytes, bytes);
  EXPECT_EQ(hatPositions(), hat);
}

TEST(RemoveRig, AccessorsStayWhereAnUnknownExtensionMayNameThem) {
  EditedCharacter character;
  changeExtension(character.scene.primitiveOf(0), "EXT_mesh_manifold") = {{"indices", 1}};
  Asset asset = character.scene.build();
  const Json accessors = documentJson(asset)["accessors"];
  removeRig(asset);
  EXPECT_EQ(documentJson(asset)["accessors"], accessors);
}

TEST(DeleteNodes, RenumbersWhatNamesNodes) {
  SceneBuilder scene;
  for (const char* name : {"a", "b", "c", "d"}) scene.addNode({{"name", name}});
  scene.node(1).children = {0, 3};
  changeExtension(scene.node(3), "MSFT_lod") = {{"ids", {2, 0}}};
  scene.addScene({1, 2});
  scene.addClip(3, "translation", 3);
  scene.addClip(0, "translation", 3);
  scene.addClip(3, "rotation", 4);
  Asset& asset = scene.asset();
  gltf::AnimationChannel::Target& target = asset.document.animations[2].channels[0].target;
  target.node.reset();
  target.path = "pointer";
  changeExtension(target, "KHR_animation_pointer") = {{"pointer", "/nodes/3/rotation"}};
  changeExtension(asset.document, "OTHER_humanoid") = {{"humanBones", {{{"node", 3}}}}};
  deleteNodes(asset, {false, true, true, true});
  const Json json = documentJson(asset);
  ASSERT_EQ(json["nodes"].size(), 3u);
  EXPECT_EQ(json["nodes"][0]["children"], Json::array({2}));
  EXPECT_EQ(json["nodes"][2]["extensions"]["MSFT_lod"]["ids"], Json::array({1}));
  EXPECT_EQ(json["scenes"][0]["nodes"], Json::array({0, 1}));
  ASSERT_EQ(json["animations"].size(), 2u);
  EXPECT_EQ(json["animations"][0]["channels"][0]["target"]["node"], 2);
  EXPECT_EQ(json["animations"][1]["channels"][0]["target"]["extensions"]["KHR_animation_pointer"]["pointer"],
            "/nodes/2/rotation");
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "node-references");
}

// --- replaceWeights ---

SkinWeights evenWeights(std::size_t vertices, std::initializer_list<Index> joints) {
  SkinWeights weights;
  weights.slots = 4;
  weights.joints.assign(4 * vertices, 0);
  weights.weights.assign(4 * vertices, 0.0f);
  for (std::size_t v = 0; v < vertices; ++v) {
    std::size_t slot = 4 * v;
    for (const Index joint : joints) {
      weights.joints[slot] = joint;
      weights.weights[slot++] = 1.0f / static_cast<float>(joints.size());
    }
  }
  return weights;
}

TEST(ReplaceWeights, KeepsJointsSkinsAndClips) {
  EditedCharacter character;
  Asset asset = character.scene.build();
  const Json before = documentJson(asset);
  const Geometry geometry = collectGeometry(asset);
  const AssetSkeleton skeleton = readSkeleton(asset);
  ASSERT_EQ(skeleton.jointNode, (std::vector<Index>{character.hip, character.chest}));
  const SkinWeights weights = evenWeights(geometry.positions.size(), {0, 1});
  replaceWeights(asset, geometry, skeleton, weights);
  checkAsset(asset);
  const Json after = documentJson(asset);
  EXPECT_EQ(after["skins"][0], before["skins"][0]);
  EXPECT_EQ(after["animations"], before["animations"]);
  EXPECT_EQ(after["nodes"][character.body], before["nodes"][character.body]);
  EXPECT_EQ(after["nodes"][character.hip], before["nodes"][character.hip]);
  const SkinWeights read = readWeights(asset, collectGeometry(asset), readSkeleton(asset));
  EXPECT_EQ(read.joints, weights.joints);
  EXPECT_EQ(read.weights, weights.weights);
}

TEST(ReplaceWeights, APartThatHungOnAJointBendsFromNowOn) {
  EditedCharacter character;
  Asset asset = character.scene.build();
  const Geometry before = collectGeometry(asset);
  replaceWeights(asset, before, readSkeleton(asset), evenWeights(before.positions.size(), {1, 0}));
  const std::vector<gltf::Node>& nodes = asset.document.nodes;
  const Index hat = nodeNamed(asset, "hat_skinned");
  EXPECT_EQ(nodes[hat].mesh, character.hatMesh);
  EXPECT_FALSE(nodes[character.hat].mesh);
  EXPECT_EQ(asset.document.skins.size(), 2u);
  EXPECT_THAT(asset.document.scenes[0].nodes, Contains(hat));
  EXPECT_TRUE(asset.warnings.empty());  // the chest's movement reaches it by its weights
  // Bind pose and stored pose are one here: the hat is where it was, though its skin now says so.
  const Geometry after = collectGeometry(asset);
  ASSERT_EQ(after.instances.size(), 2u);
  for (const PrimitiveInstance& now : after.instances) {
    for (const PrimitiveInstance& then : before.instances) {
      if (then.mesh != now.mesh) continue;
      for (Index v = 0; v < now.vertexCount; ++v) {
        EXPECT_LT((after.positions[now.firstVertex + v] - before.positions[then.firstVertex + v]).norm(), 1e-6f);
      }
    }
  }
}

TEST(ReplaceWeights, ASkinIsGivenTheJointsThatItLacks) {
  SceneBuilder scene;
  const Index tip = scene.addNode({{"name", "tip"}, {"translation", {0, 1, 0}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}});
  const Index upper = scene.addTetrahedron(Vec3f(0, 1, 0)), lower = scene.addTetrahedron();
  scene.bindRigidly(upper, {0, 0, 0, 0});
  scene.bindRigidly(lower, {0, 0, 0, 0});
  const Index upperSkin = scene.addSkin({tip}, {translation(0, -1, 0)});
  const Index lowerSkin = scene.addSkin({root}, {translation(0, 0, 0)});
  scene.asset().document.skins[upperSkin].skeleton = tip;
  scene.addNode({{"name", "upper"}, {"mesh", upper}, {"skin", upperSkin}});
  scene.addNode({{"name", "lower"}, {"mesh", lower}, {"skin", lowerSkin}});
  Asset asset = scene.build();
  const std::vector<float> oldBinds = readFloats(asset, *asset.document.skins[upperSkin].inverseBindMatrices);
  const Geometry geometry = collectGeometry(asset);
  replaceWeights(asset, geometry, readSkeleton(asset), evenWeights(8, {0, 1}));
  checkAsset(asset);
  const gltf::Skin& skin = asset.document.skins[upperSkin];
  EXPECT_EQ(skin.joints, (std::vector<Index>{tip, root}));
  EXPECT_FALSE(skin.skeleton);  // the tip is above itself only
  const std::vector<float> binds = readFloats(asset, *skin.inverseBindMatrices);
  ASSERT_EQ(binds.size(), 32u);
  EXPECT_TRUE(std::equal(oldBinds.begin(), oldBinds.end(), binds.begin()));
  EXPECT_EQ(binds[16 + 13], 0);  // the root is at the origin
  expectSamePositions(geometry, collectGeometry(asset));
}

TEST(ReplaceWeights, SkeletonsThatShareAMeshGetACommonRoot) {
  SceneBuilder scene;
  const Index left = scene.addNode({{"name", "left"}});
  const Index right = scene.addNode({{"name", "right"}, {"translation", {2, 0, 0}}});
  const Index a = scene.addTetrahedron(), b = scene.addTetrahedron(Vec3f(2, 0, 0));
  scene.bindRigidly(a, {0, 0, 0, 0});
  scene.bindRigidly(b, {0, 0, 0, 0});
  const Index first = scene.addNode({{"mesh", a}, {"skin", scene.addSkin({left}, {Affine::Identity()})}});
  const Index second = scene.addNode({{"mesh", b}, {"skin", scene.addSkin({right}, {translation(-2, 0, 0)})}});
  scene.addScene({left, right, first, second});
  Asset asset = scene.build();
  const Geometry geometry = collectGeometry(asset);
  replaceWeights(asset, geometry, readSkeleton(asset), evenWeights(8, {0, 1}));
  checkAsset(asset);
  const Index root = nodeNamed(asset, "limber_common_root");
  EXPECT_EQ(asset.document.nodes[root].children, (std::vector<Index>{left, right}));
  EXPECT_EQ(asset.document.scenes[0].nodes, (std::vector<Index>{first, second, root}));
  const Geometry after = collectGeometry(asset);
  ASSERT_EQ(after.positions.size(), 8u);
  expectSamePositions(geometry, after);
}

TEST(ReplaceWeights, MakesInverseBindsWhereThereWereNone) {
  EditedCharacter character;
  character.scene.asset().document.skins[0].inverseBindMatrices.reset();
  Asset asset = character.scene.build();
  const Geometry geometry = collectGeometry(asset);
  replaceWeights(asset, geometry, readSkeleton(asset), evenWeights(geometry.positions.size(), {0, 1}));
  EXPECT_TRUE(asset.document.skins[0].inverseBindMatrices);
  ASSERT_FALSE(asset.warnings.empty());
  EXPECT_EQ(asset.warnings.items()[0].kind, "missing-inverse-binds");
}

TEST(ReplaceWeights, ASkeletonRootThatIsNoneIsLeftOut) {
  EditedCharacter character;
  character.scene.asset().document.skins[0].skeleton = character.chest;
  Asset asset = character.scene.build();
  const Geometry geometry = collectGeometry(asset);
  replaceWeights(asset, geometry, readSkeleton(asset), evenWeights(geometry.positions.size(), {0, 1}));
  EXPECT_FALSE(asset.document.skins[0].skeleton);
  ASSERT_FALSE(asset.warnings.empty());
  EXPECT_EQ(asset.warnings.items()[0].kind, "skeleton-root");
}

TEST(ReplaceWeights, RefusesWhatDoesNotFit) {
  EditedCharacter character;
  Asset asset = character.scene.build();
  const Geometry geometry = collectGeometry(asset);
  const AssetSkeleton skeleton = readSkeleton(asset);
  EXPECT_THROW(replaceWeights(asset, geometry, skeleton, evenWeights(1, {0})), Error);
  EXPECT_THROW(replaceWeights(asset, geometry, skeleton, evenWeights(geometry.positions.size(), {2})), Error);
}

}  // namespace
}  // namespace limber
