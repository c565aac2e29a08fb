#include "limber/document/scene/geometry.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/gltf/extensions.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

using testing::SceneBuilder;
using testing::translation;

double signedVolume(const Geometry& geometry) {
  double volume = 0;
  for (const Triangle& t : geometry.triangles) {
    const Vec3 a = geometry.positions[t[0]].cast<double>(), b = geometry.positions[t[1]].cast<double>(),
               c = geometry.positions[t[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

ErrorCode errorCodeOf(const Asset& asset) {
  try {
    collectGeometry(asset);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::kCancelled;
}

TEST(CollectGeometry, TransformsOfNodesMultiplyFromTheRoot) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index child = scene.addNode({{"mesh", mesh}, {"translation", {1, 0, 0}}});
  // A quarter turn about z, twice as large.
  const Index parent = scene.addNode({{"children", {child}},
                                      {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
                                      {"scale", {2, 2, 2}},
                                      {"translation", {0, 0, 5}}});
  const Geometry geometry = collectGeometry(scene.build());
  ASSERT_EQ(geometry.positions.size(), 4u);
  EXPECT_TRUE(geometry.positions[0].isApprox(Vec3f(0, 2, 5), 1e-6f));   // (0,0,0) -> (1,0,0) -> (0,2,5)
  EXPECT_TRUE(geometry.positions[1].isApprox(Vec3f(0, 4, 5), 1e-6f));   // (1,0,0) -> (2,0,0)
  EXPECT_TRUE(geometry.positions[2].isApprox(Vec3f(-2, 2, 5), 1e-6f));  // (0,1,0) -> (1,1,0)
  EXPECT_EQ(geometry.instances.size(), 1u);
  EXPECT_EQ(geometry.instances[0].node, child);
  EXPECT_NE(geometry.instances[0].node, parent);
}

TEST(CollectGeometry, AMatrixIsColumnMajor) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}});
  const Geometry geometry = collectGeometry(scene.build());
  EXPECT_TRUE(geometry.positions[1].isApprox(Vec3f(7, 9, 9)));
}

TEST(CollectGeometry, TakesTheDefaultSceneOnly) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index first = scene.addNode({{"mesh", mesh}});
  const Index second = scene.addNode({{"mesh", mesh}});
  const Index third = scene.addNode({{"mesh", mesh}});
  scene.addScene({first});
  scene.addScene({third, second});
  scene.asset().document.scene = 1;
  Asset asset = scene.build();
  Geometry geometry = collectGeometry(asset);
  ASSERT_EQ(geometry.instances.size(), 2u);
  EXPECT_EQ(geometry.instances[0].node, third);  // in the order of the scene
  EXPECT_EQ(geometry.instances[1].node, second);

  asset.document.scene.reset();
  geometry = collectGeometry(asset);
  ASSERT_EQ(geometry.instances.size(), 1u);
  EXPECT_EQ(geometry.instances[0].node, first);

  asset.document.scenes.clear();
  EXPECT_EQ(collectGeometry(asset).instances.size(), 3u);
}

TEST(CollectGeometry, AMeshOfSeveralNodesIsThereSeveralTimes) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}});
  scene.addNode({{"mesh", mesh}, {"translation", {10, 0, 0}}});
  const Geometry geometry = collectGeometry(scene.build());
  ASSERT_EQ(geometry.instances.size(), 2u);
  EXPECT_EQ(geometry.instances[1].firstVertex, 4u);
  EXPECT_EQ(geometry.triangles.size(), 8u);
  EXPECT_TRUE(geometry.positions[4].isApprox(Vec3f(10, 0, 0)));
  EXPECT_EQ(geometry.triangles[4][0], 4u);
}

TEST(CollectGeometry, StripsAndFansKeepTheirOrientation) {
  // A unit square in the xy plane, counter-clockwise seen from +z.
  SceneBuilder scene;
  Json strip = scene.primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {});
  strip["mode"] = 5;
  Json fan = scene.primitive({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {});
  fan["mode"] = 6;
  fan["indices"] = scene.addIndices({0, 1, 2, 3});
  Json plain = scene.primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}}, {});  // a corner too many: left over
  const Index mesh = scene.addMesh(Json::array({strip, fan, plain}));
  scene.addNode({{"mesh", mesh}});
  const Geometry geometry = collectGeometry(scene.build());
  ASSERT_EQ(geometry.triangles.size(), 5u);
  double area = 0;
  for (const Triangle& t : geometry.triangles) {
    const Vec3f a = geometry.positions[t[0]], b = geometry.positions[t[1]], c = geometry.positions[t[2]];
    EXPECT_GT((b - a).cross(c - a).z(), 0);
    area += 0.5 * (b - a).cross(c - a).z();
  }
  EXPECT_DOUBLE_EQ(area, 2.5);
}

TEST(CollectGeometry, PointsAndLinesGiveVerticesOnly) {
  SceneBuilder scene;
  Json points = scene.primitive({{5, 5, 5}, {6, 6, 6}}, {});
  points["mode"] = 0;
  Json noPositions = {{"attributes", Json::object()}};
  Json solid = scene.primitive(SceneBuilder::tetrahedron(), SceneBuilder::tetrahedronTriangles());
  scene.addNode({{"mesh", scene.addMesh(Json::array({points, noPositions, solid}))}});
  const Geometry geometry = collectGeometry(scene.asset());
  EXPECT_EQ(geometry.positions.size(), 6u);
  EXPECT_EQ(geometry.triangles.size(), 4u);
  ASSERT_EQ(geometry.instances.size(), 2u);
  EXPECT_EQ(geometry.instances[1].primitive, 2u);
}

TEST(CollectGeometry, QuantisedPositionsAreWhatADrawingProgramSees) {
  SceneBuilder scene;
  const std::vector<std::uint16_t> raw = {0, 0, 0, 65535, 0, 0, 0, 65535, 0};
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t x : raw) bytes.insert(bytes.end(), {std::uint8_t(x & 0xff), std::uint8_t(x >> 8)});
  // Elements of 6 bytes are not aligned to 4 as vertex attributes must be: one component of padding each.
  std::vector<std::uint8_t> padded;
  for (std::size_t i = 0; i < bytes.size(); i += 6) {
    padded.insert(padded.end(), bytes.begin() + i, bytes.begin() + i + 6);
    padded.insert(padded.end(), {0, 0});
  }
  const Index accessor = addAccessor(scene.asset(), {3, 4, ComponentType::kU16, true}, padded, kVertexTarget);
  scene.asset().document.accessors[accessor].type = gltf::ElementType::kVec3;
  scene.asset().document.bufferViews.back().byteStride = 8;
  scene.addNode({{"mesh", scene.addMesh(Json::array({{{"attributes", {{"POSITION", accessor}}}}}))},
                 {"scale", {3, 3, 3}},
                 {"translation", {-1, 0, 0}}});
  const Geometry geometry = collectGeometry(scene.asset());
  EXPECT_TRUE(geometry.positions[0].isApprox(Vec3f(-1, 0, 0)));
  EXPECT_TRUE(geometry.positions[1].isApprox(Vec3f(2, 0, 0)));
  EXPECT_TRUE(geometry.positions[2].isApprox(Vec3f(-1, 3, 0)));
}

TEST(CollectGeometry, AMirroredPartKeepsItsOutsideOut) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
  EXPECT_NEAR(signedVolume(collectGeometry(scene.build())), 1.0 / 6, 1e-7);
}

TEST(CollectGeometry, GpuInstancesAreShownOneByOne) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index moves = scene.addPositions({{0, 0, 0}, {5, 0, 0}, {0, 5, 0}});
  const Index sizes = scene.addPositions({{1, 1, 1}, {2, 2, 2}, {1, 1, 1}});
  Json attributes = {{"TRANSLATION", moves}, {"SCALE", sizes}};
  scene.addNode({{"mesh", mesh},
                 {"translation", {0, 0, 1}},
                 {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  const Asset asset = scene.build();
  const Geometry geometry = collectGeometry(asset);
  ASSERT_EQ(geometry.instances.size(), 3u);
  EXPECT_EQ(geometry.instances[2].copy, 2u);
  EXPECT_TRUE(geometry.positions[5].isApprox(Vec3f(7, 0, 1)));  // (1,0,0) twice as large, at (5,0,1)
  EXPECT_TRUE(geometry.positions[8].isApprox(Vec3f(0, 5, 1)));

  Asset uneven = asset.clone();
  changeExtension(uneven.document.nodes[0], kInstancingName)["attributes"]["SCALE"] =
      *uneven.document.meshes[0].primitives[0].attributes.find("POSITION");  // four instead of three
  EXPECT_EQ(errorCodeOf(uneven), ErrorCode::kBadData);
}

// --- what skins position ---

// A mesh on two joints, the second a unit above the first.
struct SkinnedScene {
  SceneBuilder scene;
  Index mesh = 0, hip = 0, head = 0, body = 0, skin = 0;

  SkinnedScene() {
    mesh = scene.addTetrahedron();
    head = scene.addNode({{"name", "head"}, {"translation", {0, 1, 0}}});
    hip = scene.addNode({{"name", "hip"}, {"children", {head}}, {"translation", {0, 2, 0}}});
    skin = scene.addSkin({hip, head}, {translation(0, -2, 0), translation(0, -3, 0)});
    scene.bindRigidly(mesh, {0, 0, 1, 1});
    body = scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}, {"translation", {100, 0, 0}}});
  }
};

TEST(CollectGeometry, TheNodeOfASkinnedMeshDoesNotMoveIt) {
  SkinnedScene s;
  const Geometry geometry = collectGeometry(s.scene.build());
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_TRUE(geometry.positions[v].isApprox(SceneBuilder::tetrahedron()[v], 1e-6f)) << v;
  }
}

TEST(CollectGeometry, TheBindPoseCountsNotTheStoredPose) {
  SkinnedScene s;
  s.scene.node(s.body).translation.reset();
  s.scene.node(s.head).rotation = Vec4(1, 0, 0, 0);
  s.scene.node(s.head).translation = Vec3(4, 4, 4);
  const Geometry geometry = collectGeometry(s.scene.build());
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_TRUE(geometry.positions[v].isApprox(SceneBuilder::tetrahedron()[v], 1e-6f)) << v;
  }
}

TEST(CollectGeometry, ATransformAboveTheJointsCarriesTheModel) {
  SkinnedScene s;
  s.scene.addNode({{"children", {s.hip}}, {"scale", {10, 10, 10}}, {"translation", {0, 0, 1}}});
  const Geometry geometry = collectGeometry(s.scene.build());
  EXPECT_TRUE(geometry.positions[1].isApprox(Vec3f(10, 0, 1), 1e-6f));
}

TEST(CollectGeometry, SkinsBoundInDifferentSpacesMeetInOne) {
  // The second mesh is stored in hundredths, lying on its side; its inverse binds undo that.
  SkinnedScene s;
  Affine other = Affine::Identity();
  other.linear() = 0.01 * Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  other.translation() = Vec3(3, 1, 4);
  std::vector<Vec3f> moved;
  for (const Vec3f& p : SceneBuilder::tetrahedron())
    moved.push_back((other.inverse() * p.cast<double>()).cast<float>());
  const Index mesh = s.scene.addMesh(Json::array({s.scene.primitive(moved, SceneBuilder::tetrahedronTriangles())}));
  s.scene.bindRigidly(mesh, {0, 0, 0, 0});
  const Index skin = s.scene.addSkin({s.head}, {translation(0, -3, 0) * other});
  s.scene.addNode({{"mesh", mesh}, {"skin", skin}});
  // Even where the file stores a pose, in which the two skins disagree about the world.
  s.scene.node(s.head).rotation = Vec4(0, 0, 1, 0);
  s.scene.node(s.body).translation.reset();
  const Geometry geometry = collectGeometry(s.scene.build());
  ASSERT_EQ(geometry.positions.size(), 8u);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_LT((geometry.positions[v] - geometry.positions[v + 4]).norm(), 1e-5f) << v;
  }
}

TEST(CollectGeometry, SkinsWithoutACommonJointMeetThroughTheTree) {
  SkinnedScene s;
  const Index hat = s.scene.addNode({{"name", "hat"}, {"translation", {0, 0.5, 0}}});
  s.scene.node(s.head).children = {hat};
  const Index mesh = s.scene.addTetrahedron();
  s.scene.bindRigidly(mesh, {0, 0, 0, 0});
  const Index skin = s.scene.addSkin({hat}, {translation(0, -3.5, 0)});
  s.scene.addNode({{"mesh", mesh}, {"skin", skin}});
  s.scene.node(s.head).rotation = Vec4(0, 0, 1, 0);  // the stored pose turns head and hat over
  s.scene.node(s.body).translation.reset();
  const Geometry geometry = collectGeometry(s.scene.build());
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_LT((geometry.positions[v] - geometry.positions[v + 4]).norm(), 1e-5f) << v;
  }
}

TEST(CollectGeometry, AMeshThatHangsOnAJointStandsInTheBindPoseToo) {
  SkinnedScene s;
  const Index mesh = s.scene.addTetrahedron();
  const Index helmet = s.scene.addNode({{"mesh", mesh}, {"translation", {0, 0.25, 0}}});
  s.scene.node(s.head).children = {helmet};
  s.scene.node(s.head).translation = Vec3(9, 9, 9);  // posed away
  s.scene.node(s.body).translation.reset();
  const Geometry geometry = collectGeometry(s.scene.build());
  ASSERT_EQ(geometry.instances.size(), 2u);
  const PrimitiveInstance& part = geometry.instances[0].node == helmet ? geometry.instances[0] : geometry.instances[1];
  EXPECT_TRUE(geometry.positions[part.firstVertex].isApprox(Vec3f(0, 3.25, 0), 1e-6f));
}

TEST(CollectGeometry, WithoutInverseBindsJointsStandWhereTheirNodesAre) {
  SkinnedScene s;
  s.scene.asset().document.skins[0].inverseBindMatrices.reset();
  s.scene.node(s.hip).translation = Vec3(0, 0, 0);
  const Geometry geometry = collectGeometry(s.scene.build());
  EXPECT_TRUE(geometry.positions[1].isApprox(Vec3f(1, 0, 0), 1e-6f));
}

// --- what is refused ---

TEST(CollectGeometry, NothingToRigIsAnError) {
  SceneBuilder scene;
  EXPECT_EQ(errorCodeOf(scene.asset()), ErrorCode::kBadData);
  scene.addNode({{"name", "empty"}});
  EXPECT_EQ(errorCodeOf(scene.asset()), ErrorCode::kBadData);
}

TEST(CollectGeometry, AVertexBeyondSinglePrecisionIsAnErrorThatSaysWhere) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron(Vec3f::Zero(), 10);
  scene.addNode({{"mesh", mesh}, {"scale", {1e38, 1e38, 1e38}}});
  try {
    collectGeometry(scene.build());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    EXPECT_EQ(error.where(), "meshes[0].primitives[0]");
    EXPECT_THAT(error.message(), ::testing::HasSubstr("vertex 1 "));
  }
}

// An accessor of positions without bytes.
void addZeros(SceneBuilder& scene, Index count) {
  gltf::Accessor accessor;
  accessor.count = count;
  accessor.type = gltf::ElementType::kVec3;
  scene.asset().document.accessors.push_back(std::move(accessor));
}

TEST(CollectGeometry, AFewNodesMustNotAskForGigabytes) {
  SceneBuilder scene;
  addZeros(scene, 200000);
  const Index mesh = scene.addMesh(Json::array({{{"attributes", {{"POSITION", 0}}}}}));
  for (int i = 0; i < 22; ++i) scene.addNode({{"mesh", mesh}});
  EXPECT_EQ(errorCodeOf(scene.asset()), ErrorCode::kLimit);
}

// A node whose mesh has `vertices` of no bytes, shown `copies` times from transforms that have no bytes either.
SceneBuilder manyCopies(Index vertices, Index copies, int nodes) {
  SceneBuilder scene;
  addZeros(scene, vertices);
  addZeros(scene, copies);
  const Index mesh = scene.addMesh(Json::array({{{"attributes", {{"POSITION", 0}}}}}));
  const Json instancing = {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 1}}}}}};
  for (int i = 0; i < nodes; ++i) scene.addNode({{"mesh", mesh}, {"extensions", instancing}});
  return scene;
}

TEST(CollectGeometry, InstancesAreCountedBeforeTheyAreMade) {
  SceneBuilder many = manyCopies(3, 30'000, 9);
  EXPECT_EQ(errorCodeOf(many.asset()), ErrorCode::kLimit);
  SceneBuilder empty = manyCopies(0, 30'000, 9);
  EXPECT_EQ(errorCodeOf(empty.asset()), ErrorCode::kLimit);
}

}  // namespace
}  // namespace limber
