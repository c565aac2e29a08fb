// attachRig.
#include "limber/document/rig/rig_io.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/attached_rig.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/scene_builder.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::attach;
using testing::Attached;
using testing::documentJson;
using ::testing::HasSubstr;
using testing::mixedWeights;
using testing::SceneBuilder;
using testing::threeJoints;
using testing::translation;
using testing::warningKinds;

std::string numbered(std::string name, Index number) {
  return name.append(std::to_string(number));
}

// Linear blend skinning as glTF defines it, straight from the document: the world positions of one skinned primitive.
std::vector<Vec3> skinnedPositions(const Asset& asset, Index node, Index primitive = 0) {
  const gltf::Node& shown = asset.document.nodes[node];
  const gltf::Attributes& attributes = asset.document.meshes[*shown.mesh].primitives[primitive].attributes;
  const gltf::Skin& skin = asset.document.skins[*shown.skin];
  const SceneGraph graph = readSceneGraph(asset.document);
  const std::vector<float> inverseBinds = readFloats(asset, *skin.inverseBindMatrices);
  std::vector<Mat4> matrices;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const Eigen::Map<const Eigen::Matrix4f> inverseBind(&inverseBinds[16 * j]);
    matrices.push_back(graph.world[skin.joints[j]].matrix() * inverseBind.cast<double>());
  }
  const std::vector<float> stored = readFloats(asset, *attributes.find("POSITION"));
  std::vector<Vec3> result(stored.size() / 3, Vec3::Zero());
  for (Index set = 0; attributes.find(numbered("JOINTS_", set)); ++set) {
    const auto joints = readIndices(asset, *attributes.find(numbered("JOINTS_", set)));
    const auto weights = readFloats(asset, *attributes.find(numbered("WEIGHTS_", set)));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const Vec4 p(stored[i / 4 * 3], stored[i / 4 * 3 + 1], stored[i / 4 * 3 + 2], 1);
      result[i / 4] += weights[i] * (matrices.at(joints[i]) * p).head<3>();
    }
  }
  return result;
}

void expectPositions(const std::vector<Vec3>& actual, std::span<const Vec3f> expected, double tolerance = 1e-5) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t v = 0; v < actual.size(); ++v) {
    EXPECT_LT((actual[v] - expected[v].cast<double>()).norm(), tolerance) << "vertex " << v;
  }
}

std::span<const Vec3f> positionsOf(const Geometry& geometry, const PrimitiveInstance& instance) {
  return std::span(geometry.positions).subspan(instance.firstVertex, instance.vertexCount);
}

// The elements of a list that were there before are the same now.
void expectPrefix(const Json& before, const Json& after, const char* key) {
  if (!before.contains(key)) return;
  ASSERT_GE(after[key].size(), before[key].size());
  for (std::size_t i = 0; i < before[key].size(); ++i) EXPECT_EQ(before[key][i], after[key][i]) << key << " " << i;
}

void expectBufferKept(const Asset& before, const Asset& after) {
  const Bytes &a = before.buffers[0].bytes, &b = after.buffers[0].bytes;
  ASSERT_GE(b.size(), a.size());
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
}

Index rigRoot(const Asset& asset) {
  for (Index n = 0; n < asset.document.nodeCount(); ++n) {
    if (asset.document.nodes[n].name == "limber_rig") return n;
  }
  ADD_FAILURE() << "no limber_rig";
  return 0;
}

Index lastNode(const Asset& asset) {
  return asset.document.nodeCount() - 1;
}

TEST(AttachRig, TheBindPoseShowsTheModelWhereItWas) {
  SceneBuilder scene;
  scene.addNode({{"name", "body"}, {"mesh", scene.addTetrahedron()}});
  const Attached rigged = attach(scene.build());
  EXPECT_TRUE(hasRig(rigged.after));
  EXPECT_FALSE(hasRig(rigged.before));
  expectPositions(skinnedPositions(rigged.after, 0), rigged.geometry.positions);
}

TEST(AttachRig, AMovedJointTakesItsVerticesAlong) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}, {"scale", {2, 3, 4}}, {"translation", {1, 1, 1}}});
  Attached rigged = attach(scene.build());
  // The middle joint turns a quarter about z.
  gltf::Node& joint = rigged.after.document.nodes[rigRoot(rigged.after) + 2];
  ASSERT_EQ(joint.name, "handle_1");
  joint.rotation = Vec4(0, 0, std::sqrt(0.5), std::sqrt(0.5));

  const Skeleton skeleton = threeJoints();
  std::vector<Transform> pose = restLocals(skeleton);
  pose[1].rotation = Quat(Eigen::AngleAxisd(EIGEN_PI / 2, Vec3::UnitZ()));
  std::vector<Affine> posed(3);
  globalTransforms(skeleton, pose, posed);
  const std::vector<Affine> rest = restGlobals(skeleton);
  std::vector<Vec3f> expected;
  for (Index v = 0; v < 4; ++v) {
    Vec3 sum = Vec3::Zero();
    for (Index slot = 0; slot < 4; ++slot) {
      const Index j = rigged.weights.jointsOf(v)[slot];
      sum += rigged.weights.weightsOf(v)[slot] *
             (posed[j] * rest[j].inverse() * rigged.geometry.positions[v].cast<double>());
    }
    expected.push_back(sum.cast<float>());
  }
  expectPositions(skinnedPositions(rigged.after, lastNode(rigged.after)), expected);
  EXPECT_GT((expected[1] - rigged.geometry.positions[1]).norm(), 0.1);  // or the test would say nothing
}

TEST(AttachRig, NothingElseChanges) {
  SceneBuilder scene;
  Json primitive = scene.primitive(SceneBuilder::tetrahedron(), SceneBuilder::tetrahedronTriangles());
  primitive["attributes"]["NORMAL"] = scene.addPositions({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}});
  primitive["material"] = 0;
  primitive["extras"] = {{"tag", 7}};
  const Index mesh = scene.addMesh(Json::array({primitive}));
  scene.addNode({{"name", "body"}, {"mesh", mesh}, {"extras", {{"kept", true}}}});
  scene.addNode({{"name", "lamp"}, {"translation", {1, 2, 3}}});
  scene.addScene({0, 1});
  scene.asset().document.materials.emplace_back().name = "skin";
  scene.asset().document.extras.change() = {{"whole", "document"}};
  const Attached rigged = attach(scene.build());
  const Json before = documentJson(rigged.before), after = documentJson(rigged.after);
  for (const char* key : {"asset", "materials", "extras"}) EXPECT_EQ(before[key], after[key]);
  expectPrefix(before, after, "accessors");
  expectPrefix(before, after, "bufferViews");
  expectBufferKept(rigged.before, rigged.after);
  EXPECT_EQ(after["nodes"][1], before["nodes"][1]);

  Json node = after["nodes"][0];
  node.erase("skin");
  EXPECT_EQ(node, before["nodes"][0]);
  Json attributes = after["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_EQ(attributes.size(), 4u);
  attributes.erase("JOINTS_0");
  attributes.erase("WEIGHTS_0");
  EXPECT_EQ(attributes, before["meshes"][0]["primitives"][0]["attributes"]);
  EXPECT_EQ(after["meshes"].size(), 1u);
  EXPECT_EQ(after["scenes"][0]["nodes"], Json::array({0, 1, rigRoot(rigged.after)}));
}

TEST(AttachRig, ANodeWithATransformKeepsItAndHandsItsMeshToTheRoot) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index child = scene.addNode({{"name", "child"}});
  const Json body = {{"name", "body"}, {"children", {child}}, {"translation", {5, 0, 0}}, {"extras", {{"kept", 1}}}};
  Json withMesh = body;
  withMesh["mesh"] = mesh;
  const Index node = scene.addNode(withMesh);
  const Index parent = scene.addNode({{"children", {node}}, {"scale", {2, 2, 2}}});
  scene.addScene({parent});
  const Attached rigged = attach(scene.build());
  const Json nodes = documentJson(rigged.after)["nodes"];
  EXPECT_EQ(nodes[node], body);
  EXPECT_EQ(nodes[parent], documentJson(rigged.before)["nodes"][parent]);
  const Index moved = lastNode(rigged.after);
  EXPECT_EQ(nodes[moved]["name"], "body_skinned");
  EXPECT_EQ(nodes[moved]["mesh"], mesh);
  EXPECT_FALSE(nodes[moved].contains("translation"));
  EXPECT_THAT(rigged.after.document.scenes[0].nodes, ::testing::Contains(moved));
  expectPositions(skinnedPositions(rigged.after, moved), rigged.geometry.positions);
}

TEST(AttachRig, JointsAreNamedOnceAndSayTheirRadius) {
  SceneBuilder scene;
  scene.addNode({{"name", "handle_1"}, {"mesh", scene.addTetrahedron()}});
  const Attached rigged = attach(scene.build());
  const Json nodes = documentJson(rigged.after)["nodes"];
  std::set<std::string> names;
  for (const Json& node : nodes) EXPECT_TRUE(names.insert(node["name"].get<std::string>()).second) << node["name"];
  EXPECT_EQ(names.count("handle_1_2"), 1u);

  const Json& root = nodes[rigRoot(rigged.after)];
  ASSERT_EQ(root["children"].size(), 1u);
  const Json& first = nodes[root["children"][0].get<Index>()];
  EXPECT_EQ(first["name"], "handle_0");
  EXPECT_EQ(first["translation"].dump(), "[0.1,0.2,0.3]");  // as short as single precision allows
  EXPECT_EQ(first["extras"]["limber_radius"].dump(), "0.1");
  EXPECT_FALSE(first.contains("rotation"));
  EXPECT_EQ(rigged.after.document.skins[0].skeleton, rigRoot(rigged.after));
}

TEST(AttachRig, EachShowingOfAMeshGetsWeightsOfItsOwn) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}});
  scene.addNode({{"mesh", mesh}});
  scene.addNode({{"mesh", mesh}, {"translation", {3, 0, 0}}});
  const Attached rigged = attach(scene.build());
  const gltf::Document& document = rigged.after.document;
  ASSERT_EQ(document.meshes.size(), 3u);
  EXPECT_EQ(document.skins.size(), 2u);  // two of them have the same transform
  const auto attribute = [&](Index m, const char* name) {
    return document.meshes[m].primitives[0].attributes.find(name);
  };
  EXPECT_EQ(attribute(0, "POSITION"), attribute(2, "POSITION"));
  EXPECT_NE(attribute(0, "WEIGHTS_0"), attribute(1, "WEIGHTS_0"));
  const Index nodes[] = {0, 1, lastNode(rigged.after)};
  for (std::size_t i = 0; i < 3; ++i) {
    expectPositions(skinnedPositions(rigged.after, nodes[i]),
                    positionsOf(rigged.geometry, rigged.geometry.instances[i]));
  }
}

TEST(AttachRig, AMeshThatAnotherSceneShowsStaysAsItIs) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}});
  scene.addNode({{"mesh", mesh}});
  scene.addScene({0});
  scene.addScene({1});
  const Attached rigged = attach(scene.build());
  const Json before = documentJson(rigged.before), after = documentJson(rigged.after);
  EXPECT_EQ(after["meshes"][0], before["meshes"][0]);
  EXPECT_EQ(after["nodes"][1], before["nodes"][1]);
  EXPECT_EQ(after["scenes"][1], before["scenes"][1]);
  EXPECT_EQ(after["nodes"][0]["mesh"], 1);
}

TEST(AttachRig, TheRigIsInEverySceneThatShowsTheMesh) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  scene.addNode({{"name", "other"}});
  scene.addScene({0});
  scene.addScene({1, 0});
  scene.addScene({1});
  const Attached rigged = attach(scene.build());
  const std::vector<gltf::Scene>& scenes = rigged.after.document.scenes;
  EXPECT_EQ(scenes[0].nodes.size(), 2u);
  EXPECT_EQ(scenes[1].nodes.size(), 3u);
  EXPECT_EQ(scenes[2].nodes.size(), 1u);
}

TEST(AttachRig, MorphWeightsMoveWithTheMesh) {
  SceneBuilder scene;
  Json primitive = scene.primitive(SceneBuilder::tetrahedron(), SceneBuilder::tetrahedronTriangles());
  const Index offsets = scene.addPositions({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}});
  primitive["targets"] = Json::array({{{"POSITION", offsets}}});
  const Index node = scene.addNode({{"name", "face"},
                                    {"mesh", scene.addMesh(Json::array({primitive}))},
                                    {"weights", {0.5}},
                                    {"translation", {0, 1, 0}}});
  scene.addClip(node, "weights", 1);
  const Attached rigged = attach(scene.build());
  const Json json = documentJson(rigged.after);
  const Index moved = lastNode(rigged.after);
  EXPECT_EQ(json["nodes"][moved]["weights"], Json::array({0.5}));
  EXPECT_FALSE(json["nodes"][node].contains("weights"));
  EXPECT_EQ(json["animations"][0]["channels"][0]["target"]["node"], moved);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["targets"], Json::array({{{"POSITION", offsets}}}));
  EXPECT_TRUE(rigged.after.warnings.empty());
}

TEST(AttachRig, AnAnimationThatMovedTheMeshIsTold) {
  SceneBuilder scene;
  const Index platform = scene.addNode({{"mesh", scene.addTetrahedron()}});
  const Index lift = scene.addNode({{"children", {platform}}});
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  scene.addClip(lift, "translation", 3);
  const Attached rigged = attach(scene.build());
  ASSERT_EQ(warningKinds(rigged.after.warnings), std::vector<std::string>{"node-animation"});
  EXPECT_EQ(rigged.after.warnings.items()[0].count, 1u);
  EXPECT_EQ(documentJson(rigged.after)["animations"], documentJson(rigged.before)["animations"]);
}

TEST(AttachRig, GpuInstancesBecomeNodes) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index moves = scene.addPositions({{0, 0, 0}, {5, 0, 0}});
  Json attributes = {{"TRANSLATION", moves}};
  const Index node = scene.addNode(
      {{"name", "tree"}, {"mesh", mesh}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  scene.addScene({node});
  scene.asset().document.extensionsUsed = {"EXT_mesh_gpu_instancing", "KHR_other"};
  scene.asset().document.extensionsRequired = {"EXT_mesh_gpu_instancing"};
  const Attached rigged = attach(scene.build());
  const Json json = documentJson(rigged.after);
  EXPECT_EQ(json["nodes"][node], Json({{"name", "tree"}}));
  EXPECT_EQ(json["extensionsUsed"], Json::array({"KHR_other"}));
  EXPECT_FALSE(json.contains("extensionsRequired"));
  EXPECT_EQ(warningKinds(rigged.after.warnings), std::vector<std::string>{"expanded-instances"});
  const Index last = lastNode(rigged.after);
  expectPositions(skinnedPositions(rigged.after, last - 1), positionsOf(rigged.geometry, rigged.geometry.instances[0]));
  expectPositions(skinnedPositions(rigged.after, last), positionsOf(rigged.geometry, rigged.geometry.instances[1]));
}

TEST(AttachRig, AFlattenedNodeIsSkinnedFlat) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}, {"scale", {1, 0, 1}}, {"translation", {0, 2, 0}}});
  const Attached rigged = attach(scene.build());
  expectPositions(skinnedPositions(rigged.after, lastNode(rigged.after)), rigged.geometry.positions);
}

TEST(AttachRig, WeightsAreTidy) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  Asset asset = scene.build();
  const Geometry geometry = collectGeometry(asset);
  SkinWeights weights = mixedWeights(4, 3);
  for (Index slot = 2; slot < 4; ++slot) weights.joints[slot] = 2;               // unused slots that name a joint
  for (std::size_t i = 4; i < 8; ++i) weights.weights[i] = i < 7 ? 0.3333f : 0;  // do not sum to 1
  attachRig(asset, geometry, threeJoints(), weights);
  const gltf::Attributes& attributes = asset.document.meshes[0].primitives[0].attributes;
  const auto joints = readIndices(asset, *attributes.find("JOINTS_0"));
  const auto stored = readFloats(asset, *attributes.find("WEIGHTS_0"));
  EXPECT_EQ(accessorInfo(asset, *attributes.find("JOINTS_0")).type, ComponentType::kU8);
  for (std::size_t v = 0; v < 4; ++v) {
    float sum = 0;
    for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
      sum += stored[i];
      if (stored[i] == 0) {
        EXPECT_EQ(joints[i], 0u);
      }
    }
    EXPECT_NEAR(sum, 1, 6e-8);  // an ulp
  }
  EXPECT_FALSE(attributes.find("JOINTS_1"));
}

TEST(AttachRig, EightInfluencesTakeASecondSet) {
  Skeleton skeleton;
  for (Index j = 0; j < 9; ++j) {
    Joint joint;
    joint.name = numbered("j", j);
    joint.rest.translation = Vec3(j, 0, 0);
    skeleton.joints.push_back(joint);
  }
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  const Attached rigged = attach(scene.build(), skeleton, 7, 8);
  expectPositions(skinnedPositions(rigged.after, 0), rigged.geometry.positions);
  EXPECT_TRUE(rigged.after.document.meshes[0].primitives[0].attributes.find("WEIGHTS_1"));
  const AssetSkeleton read = readSkeleton(rigged.after);
  EXPECT_EQ(read.skeleton.joints.size(), 9u);
  const SkinWeights weights = readWeights(rigged.after, rigged.geometry, read);
  EXPECT_EQ(weights.slots, 8u);
  EXPECT_EQ(weights.joints, rigged.weights.joints);
}

TEST(AttachRig, MoreThan256JointsTakeShorts) {
  Skeleton skeleton;
  for (Index j = 0; j < 257; ++j) {
    Joint joint;
    joint.name = numbered("j", j);
    skeleton.joints.push_back(joint);
  }
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  Asset asset = scene.build();
  const Geometry geometry = collectGeometry(asset);
  SkinWeights weights = mixedWeights(4, 1, 1);
  weights.joints[0] = 256;
  attachRig(asset, geometry, skeleton, weights);
  const Index joints = *asset.document.meshes[0].primitives[0].attributes.find("JOINTS_0");
  EXPECT_EQ(accessorInfo(asset, joints).type, ComponentType::kU16);
  EXPECT_EQ(readIndices(asset, joints)[0], 256u);
}

TEST(AttachRig, ArgumentsThatDoNotFitAreRefused) {
  SceneBuilder scene;
  scene.addNode({{"mesh", scene.addTetrahedron()}});
  Asset asset = scene.build();
  const Geometry geometry = collectGeometry(asset);
  EXPECT_THROW(attachRig(asset, geometry, threeJoints(), mixedWeights(3, 3)), Error);
  EXPECT_THROW(attachRig(asset, geometry, Skeleton(), mixedWeights(4, 3)), Error);
  SkinWeights weights = mixedWeights(4, 3);
  weights.joints[0] = 3;
  EXPECT_THROW(attachRig(asset, geometry, threeJoints(), weights), Error);
  weights = mixedWeights(4, 3);
  weights.weights[5] = std::nanf("");
  EXPECT_THROW(attachRig(asset, geometry, threeJoints(), weights), Error);
}

}  // namespace
}  // namespace limber
