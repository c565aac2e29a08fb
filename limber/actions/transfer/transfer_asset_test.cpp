#include "limber/actions/transfer/transfer_asset.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "limber/actions/testing/elsewhere_skin.h"
#include "limber/actions/transfer/texture_bake.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

using testing::riggedCapsulePerson;
using testing::SceneBuilder;

Asset sceneOf(const TriMesh& mesh, const std::string& name) {
  SceneBuilder scene;
  Json primitives = Json::array({scene.primitive(mesh.positions, mesh.triangles)});
  scene.addNode({{"mesh", scene.addMesh(std::move(primitives))}});
  scene.asset().document.scene = scene.addScene({0});
  Asset asset = scene.asset().clone();
  asset.name = name;
  return asset;
}

gltf::Attributes& attributesOf(Asset& asset) {
  return asset.document.meshes[0].primitives[0].attributes;
}

Asset riggedPerson(bool withShape = false) {
  const RiggedBody person = riggedCapsulePerson();
  Asset asset = sceneOf(person.mesh, "person.glb");
  if (withShape) {
    std::vector<float> offsets;
    for (const Vec3f& p : person.mesh.positions) offsets.insert(offsets.end(), {0, p.y() > 1.6f ? 0.05f : 0.0f, 0});
    gltf::Mesh& mesh = asset.document.meshes[0];
    mesh.primitives[0].targets.emplace_back().set("POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
    mesh.extras.change()["targetNames"] = {"hat"};
  }
  attachRig(asset, collectGeometry(asset), person.skeleton, person.weights);
  return asset;
}

// A registration in a few rounds, which alike bodies need no more than.
TransferAssetOptions fewRounds() {
  TransferAssetOptions options;
  options.rig.registration.reaches = {0.05, 0.02};
  options.rig.registration.rounds = 1;
  return options;
}

TransferReport transferred(const Asset& source, Asset& target, const TransferAssetOptions& options = fewRounds()) {
  Progress progress;
  TransferReport report = transferOnto(source, target, options, progress);
  checkAsset(target);
  return report;
}

std::vector<Vec3> positionsIn(const Asset& asset) {
  return testing::jointPositions(readSkeleton(asset).skeleton);
}

// A target with a rig of its own, under other names: its joints are the landmarks.
TEST(TransferAssetTest, PutsARigOntoABodyWithAnotherOne) {
  const Asset source = riggedPerson();
  RiggedBody other = riggedCapsulePerson();
  for (Joint& joint : other.skeleton.joints) {
    joint.rest.translation *= 1.4;
    joint.name += "_old";
  }
  for (Vec3f& p : other.mesh.positions) p *= 1.4f;
  Asset target = sceneOf(other.mesh, "other.glb");
  attachRig(target, collectGeometry(target), other.skeleton, other.weights);
  const std::vector<Vec3> wanted = positionsIn(target);
  const TransferReport report = transferred(source, target);
  EXPECT_EQ(report.removedJoints, 15u);
  const Skeleton skeleton = readSkeleton(target).skeleton;
  ASSERT_EQ(skeleton.jointCount(), 15u);
  for (Index j = 0; j < 15; ++j) {
    EXPECT_EQ(skeleton.joints[j].name, riggedCapsulePerson().skeleton.joints[j].name);
    EXPECT_LT((positionsIn(target)[j] - wanted[j]).norm(), 0.005) << skeleton.joints[j].name;
  }
}

TEST(TransferAssetTest, FindsTheLimbsOfABareBody) {
  const Asset source = riggedPerson();
  Asset target = sceneOf(riggedCapsulePerson().mesh, "bare.obj");
  const TransferReport report = transferred(source, target);
  EXPECT_THAT(report.landmarksBy, ::testing::StartsWith("humanoid"));
  const Json json = toJson(report);
  std::vector<std::string> names;
  for (const Json& stage : json.at("stages")) names.push_back(stage.at("name"));
  EXPECT_THAT(names, ::testing::ElementsAre("read geometry", "fit target", "fit source", "transfer", "write rig"));
  EXPECT_EQ(json.at("stages")[1].at("steps")[0].at("name"), "measure body");
  EXPECT_FALSE(json.at("stages")[3].at("steps").empty());
  const std::vector<Vec3> wanted = positionsIn(source), found = positionsIn(target);
  for (std::size_t j = 0; j < wanted.size(); ++j) EXPECT_LT((found[j] - wanted[j]).norm(), 0.005) << j;
}

TEST(TransferAssetTest, BringsBlendShapesAlong) {
  const Asset source = riggedPerson(true);
  RiggedBody turned = riggedCapsulePerson();
  const Quat turn(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));  // lies on its side: what was up is -x
  for (Vec3f& p : turned.mesh.positions) p = (turn * p.cast<double>()).cast<float>();
  for (Joint& joint : turned.skeleton.joints) joint.rest.translation = turn * joint.rest.translation;
  Asset target = sceneOf(turned.mesh, "turned.glb");
  attachRig(target, collectGeometry(target), turned.skeleton, turned.weights);
  const TransferReport report = transferred(source, target);
  EXPECT_THAT(report.blendShapes, ::testing::ElementsAre("hat"));
  const gltf::Mesh& mesh = target.document.meshes[0];
  ASSERT_TRUE(mesh.extras.exists());
  EXPECT_EQ(mesh.extras->at("targetNames"), Json::array({"hat"}));
  const std::vector<float> offsets = readFloats(target, mesh.primitives[0].targets.at(0).find("POSITION").value());
  double most = 0;
  for (Index v = 0; v < turned.mesh.vertexCount(); ++v) {
    const bool isHat = riggedCapsulePerson().mesh.positions[v].y() > 1.6f;
    most = std::max(
        most, (Vec3(offsets[3 * v], offsets[3 * v + 1], offsets[3 * v + 2]) - Vec3(isHat ? -0.05 : 0, 0, 0)).norm());
  }
  EXPECT_LT(most, 0.01);
  Asset without = sceneOf(turned.mesh, "turned.glb");
  attachRig(without, collectGeometry(without), turned.skeleton, turned.weights);
  TransferAssetOptions options = fewRounds();
  options.blendShapes = false;
  EXPECT_TRUE(transferred(source, without, options).blendShapes.empty());
  EXPECT_TRUE(without.document.meshes[0].primitives[0].targets.empty());
}

// Its own rig and a shape that lifts all of it.
Asset liftedPerson() {
  Asset asset = riggedPerson();
  std::vector<float> offsets;
  for (std::size_t v = 0; v < riggedCapsulePerson().mesh.positions.size(); ++v) {
    offsets.insert(offsets.end(), {0, v % 2 == 0 ? 0.05f : 0.06f, 0});
  }
  asset.document.meshes[0].primitives[0].targets.emplace_back().set(
      "POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
  return asset;
}

// The person and a second mesh of one material, with the person's rig; the second hangs on the leg.
Asset personAnd(const TriMesh& other) {
  const RiggedBody person = riggedCapsulePerson();
  SceneBuilder scene;
  for (const TriMesh& mesh : {person.mesh, other}) {
    Json primitive = scene.primitive(mesh.positions, mesh.triangles);
    primitive["material"] = 0;
    scene.addNode({{"mesh", scene.addMesh(Json::array({primitive}))}});
  }
  scene.asset().document.materials.emplace_back().pbrMetallicRoughness.emplace().baseColorFactor = Vec4(1, 0, 0, 1);
  scene.asset().document.scene = scene.addScene({0, 1});
  Asset asset = scene.build();
  asset.name = "two.glb";
  SkinWeights weights = person.weights;
  for (std::size_t v = 0; v < other.positions.size(); ++v) {
    weights.joints.insert(weights.joints.end(), {9, 0});
    weights.weights.insert(weights.weights.end(), {1, 0});
  }
  attachRig(asset, collectGeometry(asset), person.skeleton, weights);
  return asset;
}

TEST(TransferAssetTest, AFloorTakesNoShapesAndNoColors) {
  TriMesh floor;
  floor.positions = {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  Asset target = personAnd(floor);
  TransferAssetOptions options = fewRounds();
  options.colors.at = [](Index, const Vec3&) { return Vec3f(0, 0.5f, 0); };
  transferred(liftedPerson(), target, options);
  const gltf::Primitive &person = target.document.meshes[0].primitives[0],
                        &ground = target.document.meshes[1].primitives[0];
  EXPECT_EQ(person.targets.size(), 1u);
  EXPECT_TRUE(ground.targets.empty());
  EXPECT_TRUE(person.attributes.find("COLOR_0"));
  EXPECT_FALSE(ground.attributes.find("COLOR_0"));
  const auto colorOf = [&](const gltf::Primitive& primitive) {
    return target.document.materials[primitive.material.value()].pbrMetallicRoughness->baseColorFactor.value();
  };
  EXPECT_EQ(colorOf(person), Vec4::Ones());
  EXPECT_EQ(colorOf(ground), Vec4(1, 0, 0, 1));
}

// The inside of the head.
TEST(TransferAssetTest, AnInnerShellTakesTheShapesOfTheOuterOne) {
  TriMesh outer, inner;
  const testing::PersonJoint& head = testing::personJoints()[2];
  testing::addCapsule(outer, head.position, head.end, head.radius);
  testing::addCapsule(inner, head.position, head.end, 0.97 * head.radius);
  Asset target = personAnd(inner);
  transferred(liftedPerson(), target);
  const auto offsetsOf = [&](Index mesh) {
    const gltf::Primitive& primitive = target.document.meshes[mesh].primitives[0];
    return readFloats(target, primitive.targets.at(0).find("POSITION").value());
  };
  const std::vector<float> ofPerson = offsetsOf(0), ofInner = offsetsOf(1);
  const std::vector<Vec3f>& positions = riggedCapsulePerson().mesh.positions;
  const auto first = std::find(positions.begin(), positions.end(), outer.positions[0]) - positions.begin();
  ASSERT_LT(static_cast<std::size_t>(first), positions.size());
  Index alike = 0;  // the others lie where the spine comes through
  for (Index v = 0; v < inner.vertexCount(); ++v) {
    const auto own = ofInner.begin() + 3 * std::ptrdiff_t{v};
    alike += std::equal(own, own + 3, ofPerson.begin() + 3 * (first + std::ptrdiff_t{v})) ? 1 : 0;
  }
  EXPECT_GT(alike, 0.9 * inner.vertexCount());
}

// What is on the back is bound four metres off in both.
TEST(TransferAssetTest, SkinsOfOtherPosesAreBroughtToOne) {
  TriMesh bag;
  testing::addCapsule(bag, {0, 1.1, -0.3}, {0, 1.3, -0.3}, 0.1);
  Asset source = personAnd(bag), target = personAnd(bag);
  for (Asset* asset : {&source, &target}) {
    const AssetSkeleton read = readSkeleton(*asset);
    testing::bindElsewhere(*asset, 1, {read.jointNode[*read.skeleton.find("leftUpperLeg")]}, Vec3f(0, 0, 4));
  }
  transferred(source, target);
  const AssetSkeleton read = readSkeleton(target);
  const Geometry geometry = collectGeometry(target);
  const SkinWeights weights = readWeights(target, geometry, read);
  const Index first = riggedCapsulePerson().mesh.vertexCount();
  for (Index v = 0; v < bag.vertexCount(); ++v) {
    EXPECT_LT((geometry.positions[first + v] - bag.positions[v]).norm(), 1e-4f) << v;
    EXPECT_EQ(read.skeleton.joints[weights.jointsOf(first + v)[0]].name, "leftUpperLeg") << v;
  }
}

// The file's own vertices are of half the size, its joints where the shape has the body.
TEST(TransferAssetTest, TheTargetIsReadAsItsShapesHaveIt) {
  RiggedBody person = riggedCapsulePerson();
  std::vector<float> offsets;
  for (Vec3f& p : person.mesh.positions) {
    p *= 0.5f;
    offsets.insert(offsets.end(), {p.x(), p.y(), p.z()});
  }
  Asset target = sceneOf(person.mesh, "small.glb");
  target.document.meshes[0].primitives[0].targets.emplace_back().set(
      "POSITION", addFloatAccessor(target, offsets, 3, kVertexTarget, true));
  target.document.nodes[0].weights = {1};
  attachRig(target, collectGeometry(target), person.skeleton, person.weights);
  transferred(riggedPerson(), target);
  const std::vector<Vec3> found = positionsIn(target), wanted = positionsIn(riggedPerson());
  for (std::size_t j = 0; j < wanted.size(); ++j) EXPECT_LT((found[j] - wanted[j]).norm(), 0.005) << j;
}

// Half as large again, with a rig of its own.
Asset tallPerson() {
  RiggedBody tall = riggedCapsulePerson();
  for (Joint& joint : tall.skeleton.joints) joint.rest.translation *= 1.5;
  for (Vec3f& p : tall.mesh.positions) p *= 1.5f;
  Asset asset = sceneOf(tall.mesh, "tall.glb");
  attachRig(asset, collectGeometry(asset), tall.skeleton, tall.weights);
  return asset;
}

TEST(TransferAssetTest, ColorsAreThoseOfThePointThatAVertexTakesAfter) {
  for (const bool isInsideOut : {false, true}) {
    RiggedBody person = riggedCapsulePerson();
    if (isInsideOut) {
      for (Triangle& t : person.mesh.triangles) std::swap(t[1], t[2]);
    }
    person.mesh.triangles.insert(person.mesh.triangles.begin() + 1, Triangle{0, 0, 1});  // which welding leaves out
    Asset source = sceneOf(person.mesh, "person.glb");
    attachRig(source, collectGeometry(source), person.skeleton, person.weights);
    Asset target = tallPerson();
    const Geometry geometry = collectGeometry(source);
    TransferAssetOptions options = fewRounds();
    // Positions as colours, so that each vertex of the target shows where it was looked up.
    options.colors.at = [&](Index triangle, const Vec3& weights) {
      Vec3f position = Vec3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        position += static_cast<float>(weights[static_cast<Eigen::Index>(k)]) *
                    geometry.positions[geometry.triangles[triangle][k]];
      }
      return Vec3f(position / 4 + Vec3f::Constant(0.5f));
    };
    transferred(source, target, options);
    const std::vector<float> colors = readFloats(target, attributesOf(target).find("COLOR_0").value());
    ASSERT_EQ(colors.size(), 4 * person.mesh.positions.size());
    for (Index v = 0; v < person.mesh.vertexCount(); ++v) {
      const Vec3f position = 4 * (Vec3f(colors[4 * v], colors[4 * v + 1], colors[4 * v + 2]) - Vec3f::Constant(0.5f));
      EXPECT_LT((position - person.mesh.positions[v]).norm(), 0.03) << v;
    }
  }
}

// Each triangle with corners of its own, and a cell of the texture.
struct UnfoldedMesh {
  TriMesh mesh;
  std::vector<Vec2f> uvs;
};

UnfoldedMesh unfolded(const TriMesh& mesh) {
  UnfoldedMesh result;
  const auto cells = static_cast<Index>(std::ceil(std::sqrt(static_cast<double>(mesh.triangleCount()))));
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vec2f cell(static_cast<float>(t % cells), static_cast<float>(t / cells));
    for (std::size_t k = 0; k < 3; ++k) {
      result.mesh.positions.push_back(mesh.positions[mesh.triangles[t][k]]);
      const Vec2f corner(k == 1 ? 0.9f : 0.1f, k == 2 ? 0.9f : 0.1f);
      result.uvs.push_back((cell + corner) / static_cast<float>(cells));
    }
    result.mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return result;
}

TEST(TransferAssetTest, ColorsGoToATextureWhereTheTargetHasRoomForOne) {
  const RiggedBody person = riggedCapsulePerson();
  const UnfoldedMesh plan = unfolded(person.mesh);
  const Asset source = riggedPerson();
  const Geometry geometry = collectGeometry(source);
  for (const bool isOverlapping : {false, true}) {
    Asset target = sceneOf(plan.mesh, "plan.glb");
    std::vector<float> uvs;
    for (const Vec2f& uv : plan.uvs) uvs.insert(uvs.end(), {uv.x(), uv.y()});
    if (isOverlapping) std::copy_n(uvs.begin(), 6, uvs.begin() + 6);  // the second triangle on the first
    attributesOf(target).set("TEXCOORD_0", addFloatAccessor(target, uvs, 2, kVertexTarget));
    SkinWeights weights;
    weights.slots = person.weights.slots;
    for (const Triangle& t : person.mesh.triangles) {
      for (const Index v : t) {
        const auto joints = person.weights.jointsOf(v);
        const auto of = person.weights.weightsOf(v);
        weights.joints.insert(weights.joints.end(), joints.begin(), joints.end());
        weights.weights.insert(weights.weights.end(), of.begin(), of.end());
      }
    }
    attachRig(target, collectGeometry(target), person.skeleton, weights);
    TransferAssetOptions options = fewRounds();
    options.colors.at = [&](Index triangle, const Vec3& at) {
      Vec3f position = Vec3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        position +=
            static_cast<float>(at[static_cast<Eigen::Index>(k)]) * geometry.positions[geometry.triangles[triangle][k]];
      }
      return Vec3f(position / 4 + Vec3f::Constant(0.5f));
    };
    std::vector<Vec3f> seen;
    options.colors.pictureSize = 512;
    options.colors.picture = [&](int size, std::span<const Vec3f> pixels) {
      EXPECT_EQ(size, 512);
      seen.assign(pixels.begin(), pixels.end());
      return Bytes{0x89, 'P', 'N', 'G', 13, 10, 26, 10};
    };
    transferred(source, target, options);
    EXPECT_EQ(attributesOf(target).find("COLOR_0").has_value(), isOverlapping);
    EXPECT_EQ(target.document.textures.empty(), isOverlapping);
    EXPECT_EQ(seen.empty(), isOverlapping);
    if (isOverlapping) continue;
    const auto texels = texelsOf(plan.mesh.triangles, plan.uvs, 512);
    ASSERT_TRUE(texels);
    EXPECT_GT(texels->size(), 10000u);
    for (const Texel& texel : *texels) {
      Vec3f wanted = Vec3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        wanted += static_cast<float>(texel.weights[static_cast<Eigen::Index>(k)]) *
                  plan.mesh.positions[plan.mesh.triangles[texel.triangle][k]];
      }
      const Vec3f position = 4 * (seen[texel.pixel] - Vec3f::Constant(0.5f));
      ASSERT_LT((position - wanted).norm(), 0.03) << texel.pixel;
    }
  }
}

TEST(TransferAssetTest, WithoutColorsTheTargetsOwnStay) {
  Asset target = tallPerson();
  const std::vector<float> red(4 * collectGeometry(target).positions.size(), 0.5f);
  attributesOf(target).set("COLOR_0", addFloatAccessor(target, red, 4, kVertexTarget));
  transferred(riggedPerson(), target);
  EXPECT_EQ(readFloats(target, attributesOf(target).find("COLOR_0").value()), red);
}

TEST(TransferAssetTest, CanBeCancelledInEveryStage) {
  const Asset source = riggedPerson();
  for (const std::string stage : {"read geometry", "fit target: ", "transfer: "}) {
    Asset target = stage == "fit target: " ? sceneOf(riggedCapsulePerson().mesh, "bare.obj") : tallPerson();
    const Json before = testing::documentJson(target);
    Progress progress([&](std::string_view message, double) {
      if (message.starts_with(stage)) progress.cancel();
    });
    try {
      transferOnto(source, target, fewRounds(), progress);
      ADD_FAILURE() << "went on: " << stage;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kCancelled) << stage;
      EXPECT_EQ(testing::documentJson(target), before);
    }
  }
}

// A box in a node of its own, behind the person's back.
void addBox(SceneBuilder& scene, const char* name, const Vec3f& middle, float size) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(middle + size * Vec3f((i & 1 ? 0.5f : -0.5f), (i & 2 ? 0.5f : -0.5f), (i & 4 ? 0.5f : -0.5f)));
  }
  const std::vector<Triangle> triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                           {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  scene.addNode({{"name", name}, {"mesh", scene.addMesh(Json::array({scene.primitive(corners, triangles)}), name)}});
}

const Vec3f kBack(0, 1.2f, -0.25f);

Asset personAndBox(const char* name) {
  SceneBuilder scene;
  const TriMesh& mesh = riggedCapsulePerson().mesh;
  scene.addNode({{"mesh", scene.addMesh(Json::array({scene.primitive(mesh.positions, mesh.triangles)}))}});
  addBox(scene, name, kBack, 0.2f);
  scene.asset().document.scene = scene.addScene({0, 1});
  Asset asset = scene.asset().clone();
  asset.name = "laden.glb";
  return asset;
}

// The person's own rig; what the box hangs on is the leg, which no neighbour of it does.
Asset riggedPersonAndBox(const char* name) {
  Asset asset = personAndBox(name);
  const RiggedBody person = riggedCapsulePerson();
  SkinWeights weights = person.weights;
  for (int corner = 0; corner < 8; ++corner) {
    weights.joints.insert(weights.joints.end(), {9, 0});
    weights.weights.insert(weights.weights.end(), {1, 0});
  }
  attachRig(asset, collectGeometry(asset), person.skeleton, weights);
  return asset;
}

SkinWeights weightsIn(const Asset& asset) {
  return readWeights(asset, collectGeometry(asset), readSkeleton(asset));
}

bool tellsOfAccessories(const TransferReport& report) {
  const std::vector<Warning>& all = report.warnings.items();
  return std::any_of(all.begin(), all.end(), [](const Warning& w) { return w.kind == "accessories"; });
}

TEST(TransferAssetTest, AccessoriesOfTheTargetFollowOneJoint) {
  Asset target = riggedPersonAndBox("Backpack");
  const TransferReport report = transferred(riggedPerson(), target);
  EXPECT_TRUE(tellsOfAccessories(report));
  const SkinWeights weights = weightsIn(target);
  const Index first = riggedCapsulePerson().mesh.vertexCount();
  ASSERT_EQ(weights.vertexCount(), first + 8);
  for (Index v = first; v < first + 8; ++v) {
    EXPECT_FLOAT_EQ(weights.weightsOf(v)[0], 1) << v;
    EXPECT_EQ(weights.jointsOf(v)[0], 1u) << v;  // the spine
  }
  const std::vector<Vec3> found = positionsIn(target), wanted = positionsIn(riggedPerson());
  for (std::size_t j = 0; j < wanted.size(); ++j) EXPECT_LT((found[j] - wanted[j]).norm(), 0.005) << j;
}

// What only the source wears gives its weights to nobody.
TEST(TransferAssetTest, AccessoriesOfTheSourceStayWithIt) {
  Asset target = riggedPerson();
  transferred(riggedPersonAndBox("Backpack"), target);
  const SkinWeights found = weightsIn(target), wanted = weightsIn(riggedPerson());
  double most = 0;
  for (Index v = 0; v < wanted.vertexCount(); ++v) {
    if (wanted.jointsOf(v)[0] == found.jointsOf(v)[0]) {
      most = std::max(most, std::abs(double{wanted.weightsOf(v)[0]} - found.weightsOf(v)[0]));
    } else {  // two that hold it about alike
      most = std::max(most, 2.0 * wanted.weightsOf(v)[0] - 1);
    }
  }
  EXPECT_LT(most, 0.2);
}

// The one bag lies on the other, and gives it its weights.
TEST(TransferAssetTest, AccessoriesOfBothArePartOfThem) {
  Asset target = riggedPersonAndBox("Old_Backpack");
  const TransferReport report = transferred(riggedPersonAndBox("Backpack"), target);
  EXPECT_FALSE(tellsOfAccessories(report));
  const SkinWeights weights = weightsIn(target);
  const Index first = riggedCapsulePerson().mesh.vertexCount();
  for (Index v = first; v < first + 8; ++v) EXPECT_EQ(weights.jointsOf(v)[0], 9u) << v;
}

TEST(TransferAssetTest, JointsKeepTheirNamesWhereNodesHaveThem) {
  Asset target = riggedPersonAndBox("head");  // no accessory: a word of the body
  const TransferReport report = transferred(riggedPerson(), target);
  EXPECT_EQ(report.removedJoints, 15u);
  const Skeleton skeleton = readSkeleton(target).skeleton;
  std::vector<std::string> names, wanted;
  for (const Joint& joint : skeleton.joints) names.push_back(joint.name);
  for (const Joint& joint : riggedCapsulePerson().skeleton.joints) wanted.push_back(joint.name);
  EXPECT_EQ(names, wanted);
  EXPECT_EQ(target.document.nodes[1].name, "head_2");
}

void expectRefused(const Asset& source, Asset& target, const std::string& what) {
  const Json before = testing::documentJson(target);
  Progress progress;
  try {
    transferOnto(source, target, {}, progress);
    ADD_FAILURE() << "took it";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(what));
    EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("\n")));
  }
  EXPECT_EQ(testing::documentJson(target), before);
}

TEST(TransferAssetTest, RefusesASourceWithoutARig) {
  Asset target = sceneOf(riggedCapsulePerson().mesh, "bare.obj");
  expectRefused(sceneOf(riggedCapsulePerson().mesh, "plain.glb"), target, "plain.glb: has no rig to transfer");
}

TEST(TransferAssetTest, RefusesWhatIsNoBody) {
  TriMesh chair;
  for (const Vec3& foot : {Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0, 0, 0.4), Vec3(0.4, 0, 0.4)}) {
    testing::addCapsule(chair, foot, foot + Vec3(0, 0.45, 0), 0.02);
  }
  testing::addCapsule(chair, Vec3(0, 0.45, 0.2), Vec3(0.4, 0.45, 0.2), 0.2);
  Asset target = sceneOf(chair, "chair.obj");
  expectRefused(riggedPerson(), target, "chair.obj: ");
}

TEST(TransferAssetTest, RefusesATargetWithoutTriangles) {
  SceneBuilder scene;
  Json primitives =
      Json::array({{{"attributes", {{"POSITION", scene.addPositions({{0, 0, 0}, {1, 0, 0}})}}}, {"mode", 0}}});
  scene.addNode({{"mesh", scene.addMesh(std::move(primitives))}});
  scene.addScene({0});
  Asset target = scene.asset().clone();
  target.name = "points.glb";
  expectRefused(riggedPerson(), target, "points.glb: ");
}

}  // namespace

}  // namespace limber
