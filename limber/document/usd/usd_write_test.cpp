#include "limber/document/usd/usd_write.h"

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/stored_archive.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/document/testing/two_bind_poses.h"
#include "limber/document/usd/usd_stage.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::SceneBuilder;

Asset everything() {
  return readAsset(testing::everythingModel().glb(), "everything.glb");
}

std::string textOf(const UsdFiles& files) {
  return {files.stage.begin(), files.stage.end()};
}
std::string textOf(const Asset& asset, UsdOptions options = {}) {
  options.form = UsdForm::kText;
  return textOf(usdFiles(asset, options));
}

// How often a text occurs in another.
std::size_t timesIn(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
  return times;
}

// The numbers of the property of that name, brackets and commas aside.
std::vector<double> numbersOf(const std::string& text, const std::string& name) {
  const std::size_t start = text.find(name + " = [");
  if (start == std::string::npos) return {};
  std::string list = text.substr(start + name.size() + 4, text.find(']', start) - start - name.size() - 4);
  for (char& c : list) c = c == '(' || c == ')' || c == ',' ? ' ' : c;
  std::vector<double> numbers;
  const char* at = list.c_str();
  char* end = nullptr;
  for (double value = std::strtod(at, &end); end != at; value = std::strtod(at, &end)) {
    numbers.push_back(value);
    at = end;
  }
  return numbers;
}

TEST(StillUsdFiles, HoldTheSurfaceThatIsGivenAndNothingThatMoves) {
  const Asset asset = everything();
  const Geometry geometry = collectGeometry(asset);
  std::vector<Vec3f> points = geometry.positions;
  const std::vector<Vec3f> normals(points.size(), Vec3f(0, 0, 1));
  const Bytes before = stillUsdFiles(asset, {points, normals}).stage;
  EXPECT_LT(before.size(), usdFiles(asset).stage.size());
  for (Vec3f& point : points) point.y() += 1;
  EXPECT_NE(stillUsdFiles(asset, {points, normals}).stage, before);
  points.pop_back();
  EXPECT_THROW(stillUsdFiles(asset, {points, normals}), Error);
}

TEST(UsdName, IsAnIdentifier) {
  EXPECT_EQ(usdName("left.hand 2"), "left_hand_2");
  EXPECT_EQ(usdName("2nd"), "_2nd");
  EXPECT_EQ(usdName(""), "_");
  EXPECT_EQ(usdName("h\xc3\xa4nd"), "h_nd");  // one letter, one underscore
  EXPECT_EQ(usdName("mixamorig:Hips"), "mixamorig_Hips");
}

TEST(UsdFiles, AModelWithEverything) {
  const UsdFiles files = usdFiles(everything(), {{}, "image", UsdForm::kText});
  const std::string text = textOf(files);
  EXPECT_EQ(text.rfind("#usda 1.0\n(\n defaultPrim = \"Model\"\n metersPerUnit = 1\n upAxis = \"Y\"\n", 0), 0u);
  EXPECT_THAT(text, HasSubstr("def SkelRoot \"Model\" ("));
  EXPECT_THAT(text, HasSubstr("uniform token[] joints = [\"root\",\"root/tip\"]"));
  EXPECT_THAT(numbersOf(text, "point3f[] points"), ElementsAre(0, 1.5, 0, 1, 1.5, 0, 0, 2.5, 0, 1, 2.5, 0));
  EXPECT_THAT(numbersOf(text, "normal3f[] normals"), ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1));
  EXPECT_THAT(numbersOf(text, "int[] faceVertexIndices"), ElementsAre(0, 1, 2, 2, 1, 3));
  EXPECT_THAT(numbersOf(text, "int[] primvars:skel:jointIndices"), ElementsAre(0, 0, 0, 1, 1, 0, 1, 0));
  EXPECT_THAT(numbersOf(text, "float[] primvars:skel:jointWeights"), ElementsAre(1, 0, .5, .5, .75, .25, 1, 0));
  EXPECT_THAT(text, HasSubstr("elementSize = 2"));
  // Half a turn about z in a second; the text says w first.
  EXPECT_THAT(text, HasSubstr("quatf[] rotations.timeSamples = {"));
  EXPECT_THAT(text, HasSubstr("0: [(1,0,0,0),(1,0,0,0)],"));
  EXPECT_THAT(text, HasSubstr("[(1,0,0,0),(0,0,0,1)],"));
  // One shape of two vertices, and its weight.
  EXPECT_THAT(numbersOf(text, "uniform vector3f[] offsets"), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(numbersOf(text, "uniform int[] pointIndices"), ElementsAre(1, 3));
  EXPECT_THAT(numbersOf(text, "float[] blendShapeWeights"), ElementsAre(0));
  // The material and its picture.
  EXPECT_THAT(text, HasSubstr("rel material:binding = </Model/Materials/red>"));
  EXPECT_THAT(text, HasSubstr("asset inputs:file = @image_0.png@"));
  ASSERT_EQ(files.images.size(), 1u);
  EXPECT_EQ(files.images[0].bytes, testing::pngBytes());
}

TEST(UsdFiles, BindTransformsAreRowsWithTheTranslationLast) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index tip = scene.addNode({{"name", "tip"}, {"translation", {0, 1, 0}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}, {"translation", {2, 0, 0}}});
  const Index skin = scene.addSkin({root, tip}, {testing::translation(-2, 0, 0), testing::translation(-2, -1, 0)});
  scene.bindRigidly(mesh, {0, 0, 1, 1});
  scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
  const std::string text = textOf(scene.build());
  const std::vector<double> bind = numbersOf(text, "uniform matrix4d[] bindTransforms");
  const std::vector<double> rest = numbersOf(text, "uniform matrix4d[] restTransforms");
  ASSERT_EQ(bind.size(), 32u);
  EXPECT_THAT(std::vector<double>(bind.begin() + 28, bind.end()), ElementsAre(2, 1, 0, 1));
  EXPECT_THAT(std::vector<double>(rest.begin() + 28, rest.end()), ElementsAre(0, 1, 0, 1));
}

TEST(UsdFiles, WithoutAClipTheJointsStandAsTheirNodesDo) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index root = scene.addNode({{"name", "root"}, {"translation", {0, 5, 0}}});
  const Index skin = scene.addSkin({root}, {Affine::Identity()});
  scene.bindRigidly(mesh, {0, 0, 0, 0});
  scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
  const std::string text = textOf(scene.build());
  EXPECT_THAT(numbersOf(text, "float3[] translations"), ElementsAre(0, 5, 0));
  const std::vector<double> rest = numbersOf(text, "uniform matrix4d[] restTransforms");
  ASSERT_EQ(rest.size(), 16u);
  EXPECT_EQ(rest[13], 5);
  EXPECT_THAT(text, Not(HasSubstr("timeSamples")));
  EXPECT_THAT(text, Not(HasSubstr("endTimeCode")));
}

TEST(UsdFiles, AClipOfNoLengthIsAPose) {
  Asset asset = everything();
  asset.document.animations[0].samplers.resize(1);
  asset.document.animations[0].channels.resize(1);
  const std::vector<float> halfTurn = {0, 0, 1, 0};
  asset.document.animations[0].samplers[0].input = addFloatAccessor(asset, std::vector<float>{0}, 1, 0, true);
  asset.document.animations[0].samplers[0].output = addFloatAccessor(asset, halfTurn, 4);
  const std::string text = textOf(asset);
  EXPECT_THAT(text, HasSubstr("quatf[] rotations = [(1,0,0,0),(0,0,0,1)]"));
  EXPECT_THAT(text, Not(HasSubstr("timeSamples")));
}

TEST(UsdFiles, SeveralRootsGetAJointAbove) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index left = scene.addNode({{"name", "root"}}), right = scene.addNode({{"name", "right"}});
  const Index skin = scene.addSkin({left, right}, {});
  scene.bindRigidly(mesh, {0, 0, 1, 1});
  scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
  const std::string text = textOf(scene.build());
  EXPECT_THAT(text, HasSubstr("joints = [\"root_2\",\"root_2/root\",\"root_2/right\"]"));
  EXPECT_THAT(numbersOf(text, "int[] primvars:skel:jointIndices"), ElementsAre(1, 1, 2, 2));
}

TEST(UsdFiles, MoreThanEightJointsOfAVertexAreReported) {
  Asset asset = everything();
  gltf::Attributes& attributes = asset.document.meshes.at(0).primitives.at(0).attributes;
  for (const char* set : {"1", "2"}) {
    attributes.set(std::string("JOINTS_") + set, attributes.find("JOINTS_0").value());
    attributes.set(std::string("WEIGHTS_") + set, attributes.find("WEIGHTS_0").value());
  }
  const auto isReported = [](const Asset& model) {
    const std::vector<Warning> warnings = usdFiles(model).warnings.items();
    return std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) { return w.kind == "many-influences"; });
  };
  EXPECT_TRUE(isReported(asset));
  EXPECT_FALSE(isReported(everything()));
}

TEST(UsdFiles, ScalesThatStandStillGoIntoTheFrames) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index tip = scene.addNode({{"name", "tip"}, {"translation", {0, 3, 0}}});
  const Index root = scene.addNode({{"name", "root"}, {"children", {tip}}, {"scale", {0.01, 0.01, 0.01}}});
  const Index skin = scene.addSkin({root, tip}, {Affine(Eigen::Scaling(100.0)), Affine(Eigen::Scaling(100.0))});
  scene.bindRigidly(mesh, {0, 0, 1, 1});
  scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
  const std::string text = textOf(scene.build());
  EXPECT_THAT(numbersOf(text, "half3[] scales"), ElementsAre(1, 1, 1, 1, 1, 1));
  EXPECT_THAT(numbersOf(text, "float3[] translations"), ElementsAre(0, 0, 0, 0, 0.03, 0));
}

TEST(UsdFiles, VerticesWithoutTrianglesAreLeftOut) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}});
  Asset asset = scene.build();
  const std::vector<std::uint8_t> one = {3, 1, 2};
  asset.document.meshes[mesh].primitives[0].indices = addAccessor(asset, {3, 1, ComponentType::kU8}, one, kIndexTarget);
  const std::string text = textOf(asset);
  EXPECT_EQ(numbersOf(text, "point3f[] points").size(), 9u);
  EXPECT_THAT(numbersOf(text, "int[] faceVertexIndices"), ElementsAre(2, 0, 1));
}

TEST(UsdFiles, ColoursOfVerticesAreMultipliedByTheMaterials) {
  Asset asset = everything();
  gltf::Document& document = asset.document;
  document.materials[0].pbrMetallicRoughness->baseColorTexture.reset();
  document.materials[0].pbrMetallicRoughness->baseColorFactor = Vec4(1, 0.5, 0.5, 0.5);
  document.materials[0].alphaMode = "BLEND";
  const std::vector<float> colors = {1, 1, 1, 1, 0, 1, 0.5, 1, 0, 0, 0, 0.5, 1, 1, 1, 1};
  document.meshes[0].primitives[0].attributes.set("COLOR_0", addFloatAccessor(asset, colors, 4, kVertexTarget));
  const std::string text = textOf(asset);
  EXPECT_THAT(numbersOf(text, "color3f[] primvars:displayColor"),
              ElementsAre(1, .5, .5, 0, .5, .25, 0, 0, 0, 1, .5, .5));
  EXPECT_THAT(numbersOf(text, "float[] primvars:displayOpacity"), ElementsAre(.5, .5, .25, .5));
  EXPECT_THAT(text, HasSubstr("inputs:diffuseColor.connect = </Model/Materials/red/VertexColor.outputs:result>"));
  EXPECT_THAT(text, HasSubstr("inputs:opacity.connect = </Model/Materials/red/VertexOpacity.outputs:result>"));
  EXPECT_THAT(text, HasSubstr("float3 inputs:fallback = (1,0.5,0.5)"));
}

TEST(UsdFiles, AModelWithoutARigIsMeshesAlone) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"name", "a b"}, {"mesh", mesh}, {"translation", {1, 0, 0}}});
  scene.addNode({{"name", "a.b"}, {"mesh", mesh}});
  const std::string text = textOf(scene.build());
  EXPECT_THAT(text, Not(HasSubstr("Skel")));
  EXPECT_THAT(text, HasSubstr("def Mesh \"a_b\""));
  EXPECT_THAT(text, HasSubstr("def Mesh \"a_b_2\""));
  EXPECT_THAT(numbersOf(text, "point3f[] points")[0], 1);  // in the world
}

TEST(UsdFiles, MeshesLeaveTheNamesOfTheirSiblings) {
  Asset asset = everything();
  gltf::Document& document = asset.document;
  for (gltf::Node& node : document.nodes) node.name = node.mesh ? "Materials" : node.name;
  std::string text = textOf(asset);
  EXPECT_EQ(timesIn(text, "def Scope \"Materials\""), 1u);
  EXPECT_THAT(text, HasSubstr("def Mesh \"Materials_2\""));
  for (gltf::Node& node : document.nodes) node.name = node.mesh ? "Skeleton" : node.name;
  text = textOf(asset);
  EXPECT_EQ(timesIn(text, "def Skeleton \"Skeleton\""), 1u);
  EXPECT_THAT(text, HasSubstr("def Mesh \"Skeleton_2\""));
}

TEST(UsdFiles, TexturesOfOtherFormatsAreToldOnce) {
  Asset asset = everything();
  asset.document.textures[0].source.reset();
  asset.document.textures[0].extensions.change()["EXT_texture_webp"] = {{"source", 0}};
  const UsdFiles files = usdFiles(asset);
  EXPECT_TRUE(files.images.empty());
  ASSERT_EQ(files.warnings.items().size(), 1u);
  EXPECT_EQ(files.warnings.items()[0].kind, "unsupported-images");
  EXPECT_EQ(files.warnings.items()[0].count, 1u);
}

TEST(UsdFiles, AnimatedNodesWithoutASkinAreJointsToo) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index node = scene.addNode({{"name", "lid"}, {"mesh", mesh}});
  scene.addClip(node, "translation", 3);
  const std::string text = textOf(scene.build());
  EXPECT_THAT(text, HasSubstr("uniform token[] joints = [\"lid\"]"));
  EXPECT_THAT(text, HasSubstr("float3[] translations.timeSamples"));
  EXPECT_EQ(numbersOf(text, "int[] primvars:skel:jointIndices").size(), 4u);
}

TEST(UsdFiles, NamesThatAreNoIdentifiersStandBeside) {
  Asset asset = everything();
  const std::string name = "\xe8\x85\xb0";
  for (gltf::Node& node : asset.document.nodes) node.name = name;
  asset.document.meshes.at(0).name = name;
  asset.document.meshes[0].extras = gltf::KeptJson(Json{{"targetNames", {"a \"b\" \\"}}});
  asset.document.materials.at(0).name = "skin\n.1";
  const std::string text = textOf(asset);
  EXPECT_THAT(text, HasSubstr("uniform token[] joints = [\"_\",\"_/__2\"]"));
  EXPECT_THAT(text, HasSubstr("uniform token[] jointNames = [\"" + name + "\",\"" + name + "_2\"]"));
  EXPECT_EQ(timesIn(text, "displayName = \"" + name + "\""), 1u);  // of the mesh
  EXPECT_EQ(timesIn(text, "displayName = \"skin.1\""), 1u);
  EXPECT_THAT(text, HasSubstr("displayName = \"a \\\"b\\\" \\\\\""));
  EXPECT_EQ(timesIn(text, "[\"a \\\"b\\\" \\\\\"]"), 2u);  // blendShapes of the mesh and of the animation
  EXPECT_THAT(textOf(everything()), Not(HasSubstr("displayName")));
  EXPECT_THAT(textOf(everything()), Not(HasSubstr("jointNames")));
}

TEST(UsdFiles, OneClipAFileAndANameThatIsThere) {
  Asset asset = everything();
  asset.document.animations.push_back(asset.document.animations[0]);
  asset.document.animations[1].name = "stand";
  asset.document.animations[1].channels.clear();
  EXPECT_EQ(timesIn(textOf(asset), "def SkelAnimation"), 1u);
  EXPECT_THAT(textOf(asset, {"turn"}), HasSubstr("rotations.timeSamples"));
  EXPECT_THAT(textOf(asset, {"stand"}), Not(HasSubstr("timeSamples")));
  try {
    textOf(asset, {"run"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_THAT(error.what(), HasSubstr("turn, stand"));
  }
}

TEST(UsdFiles, StepsHoldUntilTheirKey) {
  Asset asset = everything();
  asset.document.animations[0].samplers[0].interpolation = Interpolation::kStep;
  // The first value again, just before the second key.
  EXPECT_EQ(timesIn(textOf(asset), "[(1,0,0,0),(1,0,0,0)],"), 2u);
}

TEST(UsdFiles, VerticesWithoutWeightsStayWithTheFirstJoint) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index root = scene.addNode({{"name", "root"}});
  const Index skin = scene.addSkin({root}, {});
  scene.bind(mesh, std::vector<std::uint8_t>(16, 0), {1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}});
  EXPECT_THAT(numbersOf(textOf(scene.build()), "float[] primvars:skel:jointWeights"), ElementsAre(1, 1, 1, 1));
}

TEST(EncodeUsdz, FilesLieAtMultiplesOf64AndComeBack) {
  const UsdFiles files = usdFiles(everything());
  const Bytes archive = encodeUsdz(files);
  const std::map<std::string, Bytes> back = readZipArchive(archive, "model.usdz");
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back.at("model.usdc"), files.stage);
  EXPECT_EQ(back.at("image_0.png"), files.images[0].bytes);
  const auto offsetOf = [&](const auto& bytes) {
    return std::search(archive.begin(), archive.end(), bytes.begin(), bytes.end()) - archive.begin();
  };
  EXPECT_EQ(offsetOf(files.stage) % 64, 0);
  EXPECT_EQ(offsetOf(files.images[0].bytes) % 64, 0);
  EXPECT_EQ(encodeUsdz(files), archive);
}

// Of all meshes of the text, one after the other.
std::vector<double> pointsOf(const std::string& text) {
  std::vector<double> points;
  const std::string name = "point3f[] points";
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::vector<double> more = numbersOf(text.substr(at), name);
    points.insert(points.end(), more.begin(), more.end());
  }
  return points;
}

TEST(UsdFiles, PointsAreThoseOfOneBindPose) {
  const std::vector<double> wanted = pointsOf(textOf(testing::partsInTwoBindPoses(Vec3f::Zero())));
  ASSERT_EQ(wanted.size(), 24u);
  const Asset elsewhere = testing::partsInTwoBindPoses({0, 5, 0}),
              unbound = testing::partsInTwoBindPoses({0, 0, -3}, false);
  ASSERT_FALSE(unbound.document.skins[1].inverseBindMatrices);
  for (const Asset* asset : {&elsewhere, &unbound}) {
    EXPECT_THAT(pointsOf(textOf(*asset)), ::testing::Pointwise(::testing::DoubleNear(1e-5), wanted));
  }
}

}  // namespace
}  // namespace limber
