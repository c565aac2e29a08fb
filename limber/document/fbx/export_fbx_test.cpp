#include "limber/document/fbx/export_fbx.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/document/clip/clip_moment.h"
#include "limber/document/fbx/export_fbx_angles.h"
#include "limber/document/fbx/records/testing/fbx_reader.h"
#include "limber/document/read.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/testing/scene_builder.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::SceneBuilder;

Asset everything() {
  return readAsset(testing::everythingModel().glb(), "everything.glb");
}

// What a file says, as a program would look it up.
class FbxFileView {
 public:
  explicit FbxFileView(const Asset& asset, const FbxOptions& options = {}) : made_(encodeFbx(asset, options)) {
    records_ = testing::FbxTestReader(made_.bytes).read();
    for (const FbxNode& object : record("Objects").children) {
      const std::string& name = std::get<std::string>(object.values[1]);
      byName_[object.name + " " + name.substr(0, name.find('\0'))] = &object;
      byId_[idOf(object)] = &object;
    }
  }

  const Warnings& warnings() const { return made_.warnings; }

  const FbxNode& record(std::string_view name) const {
    for (const FbxNode& one : records_) {
      if (one.name == name) return one;
    }
    throw std::runtime_error("no record " + std::string(name));
  }

  bool has(const std::string& name) const { return byName_.count(name) > 0; }
  const FbxNode& object(const std::string& name) const { return *byName_.at(name); }  // "Model root"
  std::size_t count(std::string_view type) const {
    std::size_t found = 0;
    for (const FbxNode& one : record("Objects").children) found += one.name == type;
    return found;
  }

  static std::int64_t idOf(const FbxNode& object) { return std::get<std::int64_t>(object.values[0]); }

  // Objects connected to one (their property, where there is one, is `property`).
  std::vector<const FbxNode*> below(const FbxNode& object, std::string_view property = {}) const {
    std::vector<const FbxNode*> found;
    for (const FbxNode& link : record("Connections").children) {
      const bool isProperty = link.values.size() > 3;
      if (std::get<std::int64_t>(link.values[2]) != idOf(object) || isProperty == property.empty()) continue;
      if (isProperty && std::get<std::string>(link.values[3]) != property) continue;
      found.push_back(byId_.at(std::get<std::int64_t>(link.values[1])));
    }
    return found;
  }

  const FbxNode* parent(const FbxNode& object) const {
    for (const FbxNode& link : record("Connections").children) {
      if (std::get<std::int64_t>(link.values[1]) != idOf(object) || link.values.size() > 3) continue;
      const auto known = byId_.find(std::get<std::int64_t>(link.values[2]));
      if (known != byId_.end() && known->second->name == "Model") return known->second;
    }
    return nullptr;
  }

  static std::vector<double> property(const FbxNode& object, std::string_view name) {
    for (const FbxNode& one : object.find("Properties70")->children) {
      if (std::get<std::string>(one.values[0]) != name) continue;
      std::vector<double> numbers;
      for (std::size_t v = 4; v < one.values.size(); ++v) {
        const auto* whole = std::get_if<std::int32_t>(&one.values[v]);
        numbers.push_back(whole != nullptr ? *whole : std::get<double>(one.values[v]));
      }
      return numbers;
    }
    return {};
  }

  template <typename Number>
  static std::vector<Number> array(const FbxNode& object, std::string_view child) {
    return std::get<std::vector<Number>>(object.find(child)->values[0]);
  }

  static Affine matrix(const FbxNode& object, std::string_view child) {
    Affine result;
    result.matrix() = Eigen::Map<const Mat4>(array<double>(object, child).data());
    return result;
  }

  Affine world(const FbxNode& model) const {
    const auto part = [&](const char* name) {
      const std::vector<double> numbers = property(model, name);
      return Vec3(numbers[0], numbers[1], numbers[2]);
    };
    const Vec3 turn = part("Lcl Rotation") * kDegree;
    Affine local = Eigen::Translation3d(part("Lcl Translation")) * Eigen::AngleAxisd(turn.z(), Vec3::UnitZ()) *
                   Eigen::AngleAxisd(turn.y(), Vec3::UnitY()) * Eigen::AngleAxisd(turn.x(), Vec3::UnitX()) *
                   Eigen::Scaling(part("Lcl Scaling"));
    const FbxNode* above = parent(model);
    return above != nullptr ? world(*above) * local : local;
  }

 private:
  FbxExport made_;
  std::vector<FbxNode> records_;
  std::map<std::string, const FbxNode*> byName_;
  std::map<std::int64_t, const FbxNode*> byId_;
};

TEST(EncodeFbx, AModelWithEverything) {
  const FbxFileView file(everything());
  const FbxNode &root = file.object("Model root"), &tip = file.object("Model tip"), &body = file.object("Model body");
  EXPECT_EQ(std::get<std::string>(root.values[2]), "LimbNode");
  EXPECT_EQ(std::get<std::string>(body.values[2]), "Mesh");
  EXPECT_EQ(file.parent(tip), &root);
  EXPECT_EQ(file.parent(file.object("Model eye")), &root);
  EXPECT_THAT(FbxFileView::property(root, "Lcl Translation"), ElementsAre(0, 150, 0));  // centimetres
  EXPECT_THAT(FbxFileView::property(root, "InheritType"), ElementsAre(1));

  const FbxNode& surface = file.object("Geometry square");
  EXPECT_THAT(FbxFileView::array<double>(surface, "Vertices"), ElementsAre(0, 0, 0, 100, 0, 0, 0, 100, 0, 100, 100, 0));
  EXPECT_THAT(FbxFileView::array<std::int32_t>(surface, "PolygonVertexIndex"), ElementsAre(0, 1, ~2, 2, 1, ~3));
  EXPECT_THAT(FbxFileView::array<double>(*surface.find("LayerElementNormal"), "Normals"),
              ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1));

  // One blend shape, of two vertices.
  const FbxNode& shape = file.object("Geometry shape_0");
  EXPECT_THAT(FbxFileView::array<std::int32_t>(shape, "Indexes"), ElementsAre(1, 3));
  EXPECT_THAT(FbxFileView::array<double>(shape, "Vertices"), ElementsAre(100, 200, 300, 400, 500, 600));

  // The material and its picture.
  const std::vector<const FbxNode*> belowBody = file.below(body);
  EXPECT_EQ(belowBody.back(), &file.object("Material red"));
  const std::vector<const FbxNode*> textures = file.below(*belowBody.back(), "DiffuseColor");
  ASSERT_EQ(textures.size(), 1u);
  const FbxNode& video = *file.below(*textures[0]).front();
  EXPECT_EQ(std::get<Bytes>(video.find("Content")->values[0]), testing::pngBytes());
}

// Positions of all vertices by the clusters, at rest and at one time of the clip.
TEST(EncodeFbx, ClustersPutTheVerticesWhereLimberHasThem) {
  Asset asset = everything();
  const FbxFileView file(asset);
  const Geometry geometry = collectGeometry(asset);
  const FbxNode& skin = *file.below(file.object("Geometry square")).back();
  ASSERT_EQ(std::get<std::string>(skin.values[2]), "Skin");
  const std::vector<double> points = FbxFileView::array<double>(file.object("Geometry square"), "Vertices");
  std::vector<Vec3> placed(4, Vec3::Zero());
  for (const FbxNode* cluster : file.below(skin)) {
    const FbxNode& joint = *file.below(*cluster).front();
    const Affine link = FbxFileView::matrix(*cluster, "TransformLink");
    EXPECT_TRUE(link.isApprox(file.world(joint), 1e-9));
    const Affine moves = file.world(joint) * FbxFileView::matrix(*cluster, "Transform");
    const auto vertices = FbxFileView::array<std::int32_t>(*cluster, "Indexes");
    const auto weights = FbxFileView::array<double>(*cluster, "Weights");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto v = static_cast<std::size_t>(vertices[i]);
      placed[v] += weights[i] * (moves * Eigen::Map<const Vec3>(&points[3 * v]));
    }
  }
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_TRUE(placed[v].isApprox(100 * geometry.positions[v].cast<double>(), 1e-6)) << v;
  }
}

TEST(EncodeFbx, MetresAndZUp) {
  const FbxFileView file(everything(), {FbxUnit::kMetre, FbxUpAxis::kZ, {}});
  const FbxNode& settings = file.record("GlobalSettings");
  EXPECT_THAT(FbxFileView::property(settings, "UnitScaleFactor"), ElementsAre(100));
  EXPECT_THAT(FbxFileView::property(settings, "UpAxis"), ElementsAre(2));
  EXPECT_THAT(FbxFileView::property(settings, "FrontAxisSign"), ElementsAre(-1));
  const Vec3 root = file.world(file.object("Model root")).translation();
  EXPECT_TRUE(root.isApprox(Vec3(0, 0, 1.5), 1e-9));
  EXPECT_TRUE((file.world(file.object("Model tip")).linear() * Vec3::UnitZ()).isApprox(-Vec3::UnitY(), 1e-6));
}

TEST(EncodeFbx, TheFrameRateShowsWhatLiesBetweenKeysThatAreFarApart) {
  const FbxNode settings = FbxFileView(everything()).record("GlobalSettings");  // keys at 0, 0.5 and 1 s
  EXPECT_THAT(FbxFileView::property(settings, "TimeMode"), ElementsAre(6));     // 30 a second
  EXPECT_THAT(FbxFileView::property(settings, "CustomFrameRate"), ElementsAre(-1));
}

TEST(EncodeFbx, AClipIsAStackWithCurves) {
  const FbxFileView file(everything());
  const FbxNode& stack = file.object("AnimationStack turn");
  const FbxNode& layer = *file.below(stack).front();
  const std::vector<const FbxNode*> nodes = file.below(layer);
  ASSERT_EQ(nodes.size(), 1u);  // the rotation of tip; nothing else moves
  EXPECT_EQ(file.below(file.object("Model tip"), "Lcl Rotation"), nodes);
  const FbxNode& z = *file.below(*nodes[0], "d|Z").front();
  EXPECT_THAT(FbxFileView::array<std::int64_t>(z, "KeyTime"), ElementsAre(0, 23093079000, 46186158000));
  const auto degrees = FbxFileView::array<float>(z, "KeyValueFloat");
  EXPECT_NEAR(degrees[1], 0.5 * degrees[2], 1e-4);
  EXPECT_NEAR(std::abs(degrees[2]), 180, 1e-4);
  EXPECT_EQ(FbxFileView::array<float>(*file.below(*nodes[0], "d|X").front(), "KeyValueFloat").size(), 1u);
  EXPECT_EQ(std::get<std::string>(file.record("Takes").children[0].values[0]), "turn");
}

TEST(EncodeFbx, ClipsThatAreAskedFor) {
  Asset asset = everything();
  asset.document.animations.push_back(asset.document.animations[0]);
  asset.document.animations[1].name = "again";
  EXPECT_EQ(FbxFileView(asset).count("AnimationStack"), 2u);
  EXPECT_TRUE(FbxFileView(asset, {.clips = {{"again"}}}).has("AnimationStack again"));
  EXPECT_EQ(FbxFileView(asset, {.clips = {{"again"}}}).count("AnimationStack"), 1u);
  EXPECT_EQ(FbxFileView(asset, {.clips = std::vector<std::string>()}).count("AnimationStack"), 0u);
  try {
    encodeFbx(asset, {.clips = {{"run"}}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_THAT(error.what(), HasSubstr("turn, again"));
  }
}

TEST(EncodeFbx, PrimitivesBecomeOneGeometryWithMaterialNumbers) {
  SceneBuilder scene;
  Json first = scene.primitive(SceneBuilder::tetrahedron(), SceneBuilder::tetrahedronTriangles());
  Json second = first, third = scene.primitive(SceneBuilder::tetrahedron({5, 0, 0}), {{0, 2, 1}});
  first["material"] = 1;
  second["material"] = 0;
  third["material"] = 1;
  const Index mesh = scene.addMesh(Json::array({first, second, third}), "pieces");
  scene.addNode({{"name", "thing"}, {"mesh", mesh}});
  scene.asset().document.materials.resize(2);
  scene.asset().document.materials[0].name = "a";
  scene.asset().document.materials[1].name = "b";
  const FbxFileView file(scene.build());
  const FbxNode& surface = file.object("Geometry pieces");
  EXPECT_EQ(FbxFileView::array<double>(surface, "Vertices").size(), 3u * 8);  // two primitives share vertices
  EXPECT_THAT(FbxFileView::array<std::int32_t>(*surface.find("LayerElementMaterial"), "Materials"),
              ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, 0));
  const std::vector<const FbxNode*> below = file.below(file.object("Model thing"));
  EXPECT_THAT(below, ElementsAre(&surface, &file.object("Material b"), &file.object("Material a")));
}

TEST(EncodeFbx, TexturesWithoutAnImageOfItsOwnFormatsAreTold) {
  Asset asset = everything();
  asset.document.textures[0].source.reset();
  asset.document.textures[0].extensions.change()["EXT_texture_webp"] = {{"source", 0}};
  const FbxFileView file(asset);
  EXPECT_EQ(file.count("Texture"), 0u);
  EXPECT_THAT(testing::warningKinds(file.warnings()), ::testing::Contains("unsupported-images"));
}

TEST(EncodeFbx, NodesThatShowOneMeshShareItsGeometry) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"name", "left"}, {"mesh", mesh}, {"translation", {1, 0, 0}}});
  scene.addNode({{"name", "right"}, {"mesh", mesh}});
  const FbxFileView file(scene.build());
  EXPECT_EQ(file.count("Geometry"), 1u);
  EXPECT_EQ(file.below(file.object("Model left")).front(), file.below(file.object("Model right")).front());
}

TEST(EncodeFbx, AJointsMeshHangsBelowIt) {
  SceneBuilder scene;
  const Index skinned = scene.addTetrahedron(), hat = scene.addTetrahedron({0, 2, 0});
  const Index head = scene.addNode({{"name", "head"}, {"mesh", hat}, {"translation", {0, 1, 0}}});
  const Index skin = scene.addSkin({head}, {});
  scene.bindRigidly(skinned, {0, 0, 0, 0});
  scene.addNode({{"name", "body"}, {"mesh", skinned}, {"skin", skin}});
  const FbxFileView file(scene.build());
  EXPECT_EQ(std::get<std::string>(file.object("Model head").values[2]), "LimbNode");
  EXPECT_EQ(file.parent(file.object("Model head_mesh")), &file.object("Model head"));
  EXPECT_TRUE(file.world(file.object("Model head_mesh")).translation().isApprox(Vec3(0, 100, 0), 1e-9));
}

// glTF ignores the transform of a skinned mesh's node; FBX does not.
TEST(EncodeFbx, ASkinnedMeshStandsWhereItWasBound) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  const Index root = scene.addNode({{"name", "root"}, {"translation", {0, 3, 0}}});
  const Index skin = scene.addSkin({root}, {testing::translation(0, -3, 0)});
  scene.bindRigidly(mesh, {0, 0, 0, 0});
  const Index body = scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", skin}, {"translation", {7, 0, 0}}});
  scene.addNode({{"name", "holder"}, {"children", {body}}, {"scale", {2, 2, 2}}});
  const FbxFileView file(scene.build());
  EXPECT_EQ(file.parent(file.object("Model body")), &file.object("Model holder"));
  EXPECT_TRUE(file.world(file.object("Model body")).isApprox(Affine::Identity(), 1e-9));
}

TEST(EncodeFbx, NamesAreUniqueAndCountedWhereTheyChange) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  scene.addNode({{"name", "a"}, {"mesh", mesh}});
  scene.addNode({{"name", "a"}, {"mesh", mesh}});
  const FbxFileView file(scene.build());
  EXPECT_TRUE(file.has("Model a"));
  EXPECT_TRUE(file.has("Model a_2"));
  ASSERT_EQ(file.warnings().items().size(), 1u);
  EXPECT_EQ(file.warnings().items()[0].kind, "renamed-nodes");
}

TEST(EncodeFbx, WeightsOfBlendShapesMoveInPercent) {
  SceneBuilder scene;
  const Index mesh = scene.addTetrahedron();
  gltf::Attributes target;
  target.set("POSITION", scene.addPositions(SceneBuilder::tetrahedron()));
  scene.primitiveOf(mesh).targets.push_back(target);
  scene.addClip(scene.addNode({{"name", "face"}, {"mesh", mesh}, {"weights", {0.25}}}), "weights", 1);
  const FbxFileView file(scene.build());
  const FbxNode& channel = file.object("Deformer shape_0");
  EXPECT_THAT(FbxFileView::property(channel, "DeformPercent"), ElementsAre(25));
  const FbxNode& node = *file.below(channel, "DeformPercent").front();
  const FbxNode& curve = *file.below(node, "d|DeformPercent").front();
  EXPECT_THAT(FbxFileView::array<float>(curve, "KeyValueFloat"), ElementsAre(50));
}

// The model's scale is mirrored on x, the clip knows the node's own rotation alone.
TEST(EncodeFbx, MirroredNodesTurnAsTheirClipsSay) {
  for (const Vec3& scale : {Vec3(1, 1, -1), Vec3(-1, -2, 1), Vec3(1, -1, 1)}) {
    SceneBuilder scene;
    const Json numbers = {scale.x(), scale.y(), scale.z()};
    scene.addClip(scene.addNode({{"name", "thing"}, {"mesh", scene.addTetrahedron()}, {"scale", numbers}}), "rotation",
                  4);
    const FbxFileView file(scene.build());
    const FbxNode& model = file.object("Model thing");
    const FbxNode& node = *file.below(model, "Lcl Rotation").front();
    const auto degrees = [&](const char* axis) {
      return double{FbxFileView::array<float>(*file.below(node, axis).front(), "KeyValueFloat").at(0)};
    };
    const Quat turn = eulerRotation({degrees("d|X"), degrees("d|Y"), degrees("d|Z")});
    const Vec3 shown(FbxFileView::property(model, "Lcl Scaling").data());
    const Mat3 got = turn.toRotationMatrix() * shown.asDiagonal();
    const Mat3 wanted = Quat(0.5, 0.5, 0.5, 0.5).toRotationMatrix() * scale.asDiagonal();
    EXPECT_LT((got - wanted).cwiseAbs().maxCoeff(), 1e-6) << scale.transpose();
  }
}

TEST(EncodeFbx, SameDocumentSameBytes) {
  EXPECT_EQ(encodeFbx(everything()).bytes, encodeFbx(everything()).bytes);
}

}  // namespace
}  // namespace limber
