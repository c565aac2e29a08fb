#include "limber/session/edit/taken_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/known_error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/npy_bytes.h"
#include "limber/document/testing/stored_zip.h"
#include "limber/document/write.h"
#include "limber/session/scene/scene.h"
#include "limber/session/session_state.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

using testing::perform;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The named person, whose joints have other names, and whose head can grow.
Bytes heroGlb() {
  Asset asset = readAsset(testing::namedPersonGlb(), "hero.glb");
  const AssetSkeleton skeleton = readSkeleton(asset);
  for (const Index node : skeleton.jointNode) asset.document.nodes[node].name += "_hero";
  const Geometry geometry = collectGeometry(asset);
  std::vector<float> offsets;
  for (const Vec3f& p : geometry.positions) offsets.insert(offsets.end(), {0, p.y() > 1.5f ? 0.1f : 0, 0});
  gltf::Mesh& mesh = asset.document.meshes[0];
  mesh.primitives[0].targets.emplace_back().set("POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
  mesh.extras.change()["targetNames"] = {"proud"};
  return writeGlb(asset);
}

// Half as large again.
Bytes giantGlb() {
  Asset asset = readAsset(testing::namedPersonGlb(), "giant.glb");
  std::vector<Index>& roots = asset.document.scenes[0].nodes;
  gltf::Node giant;
  giant.name = "giant";
  giant.scale = Vec3::Constant(1.5);
  giant.children = roots;
  roots = {addElement(asset.document.nodes, std::move(giant))};
  return writeGlb(asset);
}

// Walks by a clip of its own.
Bytes walkerGlb() {
  Asset asset = readAsset(testing::namedPersonGlb(), "walker.glb");
  const AssetSkeleton skeleton = readSkeleton(asset);
  const PoseSequence walk = testing::walk(skeleton.skeleton, 31, 30);
  addClips(asset, skeleton, std::vector{clipOf(skeleton.skeleton, walk, "walk")});
  return writeGlb(asset);
}

// The named person as arrays in SMPL's layout.
Bytes personNpz() {
  const Asset asset = readAsset(testing::namedPersonGlb(), "person.glb");
  const Geometry geometry = collectGeometry(asset);
  const AssetSkeleton skeleton = readSkeleton(asset);
  const SkinWeights weights = readWeights(asset, geometry, skeleton);
  const std::size_t vertices = geometry.positions.size(), joints = skeleton.skeleton.jointCount();
  std::vector<double> positions, coordinates, fractions(vertices * joints, 0), corners, tree(joints, -1);
  for (const Vec3f& p : geometry.positions) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
  for (const Affine& global : restGlobals(skeleton.skeleton)) {
    const Vec3 p = global.translation();
    coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  }
  for (const Triangle& t : geometry.triangles) corners.insert(corners.end(), t.begin(), t.end());
  for (Index v = 0; v < vertices; ++v) fractions[v * joints + weights.jointsOf(v)[0]] = 1;
  for (std::size_t j = 0; j < joints; ++j) {
    if (const auto& parent = skeleton.skeleton.joints[j].parent) tree[j] = *parent;
  }
  for (std::size_t j = 0; j < joints; ++j) tree.push_back(static_cast<double>(j));
  std::vector<std::pair<std::string, std::string>> files;
  const auto add = [&](const char* name, const std::vector<std::size_t>& shape, const std::vector<double>& values) {
    const Bytes array = testing::npyDoubles(shape, values);
    files.emplace_back(name, std::string(array.begin(), array.end()));
  };
  add("v_template.npy", {vertices, 3}, positions);
  add("f.npy", {geometry.triangles.size(), 3}, corners);
  add("weights.npy", {vertices, joints}, fractions);
  add("kintree_table.npy", {2, joints}, tree);
  add("J.npy", {joints, 3}, coordinates);
  return testing::storedZip(files);
}

std::optional<Bytes> rigFiles(std::string_view path) {
  if (path == "hero.glb") return heroGlb();
  if (path == "giant.glb") return giantGlb();
  if (path == "walker.glb") return walkerGlb();
  if (path == "person.npz") return personNpz();
  if (path == "biped.glb") return testing::bipedGlb();
  return path == "walk.bvh" ? std::optional<Bytes>(testing::walkBvh()) : std::nullopt;
}

Session openedModel(const std::string& file) {
  Session session(rigFiles);
  perform(session, OpenFile{file});
  return session;
}

std::vector<std::string> jointNames(const Session& session) {
  std::vector<std::string> names;
  for (const Joint& joint : session.state().rig->skeleton().joints) names.push_back(joint.name);
  return names;
}

std::optional<ErrorKind> refusalKindOf(Session& session, const Command& command) {
  try {
    perform(session, command);
  } catch (const KnownError& error) {
    return error.kind();
  }
  return std::nullopt;
}

TEST(TakenRig, AnotherModelsJointsWeightsAndShapesComeOver) {
  Session session = openedModel("giant.glb");
  const Bytes before = session.exportModel(ExportFormat::kGlb);
  const std::vector<std::string> oldNames = jointNames(session);
  const std::vector<Affine> oldTransforms = restGlobals(session.state().rig->skeleton());
  EXPECT_EQ(sessionState(session)["gaps"], nullptr);
  perform(session, TransferRig{"hero.glb"});
  const RiggedModel& rig = *session.state().rig;
  ASSERT_EQ(jointNames(session).size(), oldNames.size());
  const std::vector<Affine> transforms = restGlobals(rig.skeleton());
  for (std::size_t j = 0; j < oldNames.size(); ++j) {
    EXPECT_EQ(jointNames(session)[j], oldNames[j] + "_hero");
    EXPECT_LT((transforms[j].translation() - oldTransforms[j].translation()).norm(), 0.02) << oldNames[j];
  }
  const Json state = sessionState(session);
  EXPECT_EQ(state["own_rig"], true);
  EXPECT_EQ(state["undo"], "transfer_rig");
  EXPECT_LT(state["gaps"]["rms"].get<double>(), 0.5);
  EXPECT_THAT(testing::documentJson(rig.asset()).dump(), HasSubstr("\"proud\""));
  perform(session, Undo{});
  EXPECT_EQ(session.exportModel(ExportFormat::kGlb), before);
}

TEST(TakenRig, TheRecordAndASavedSessionGiveTheSameModel) {
  Session session = openedModel("giant.glb");
  perform(session, TransferRig{"hero.glb"});
  perform(session, testing::turnedBy("head_hero", Vec3::UnitY(), 30));
  const Bytes model = session.exportModel(ExportFormat::kGlb);
  Session replayed(rigFiles), opened;
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) perform(replayed, command);
  EXPECT_EQ(replayed.exportModel(ExportFormat::kGlb), model);
  Progress progress;
  opened.open(session.saveSession(), "saved.glb", progress);
  EXPECT_EQ(jointNames(opened), jointNames(session));
  EXPECT_TRUE(samePose(opened.state().pose, session.state().pose));
  EXPECT_EQ(opened.exportModel(ExportFormat::kGlb), model);
}

TEST(TakenRig, PoseAndClipsComeAlong) {
  Session session = openedModel("giant.glb");
  perform(session, AddMotion{"walk.bvh", true});
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  perform(session, SetTime{0.3});
  const std::vector<Vec3f> before = posedPositions(*session.state().rig, session.state().pose);
  perform(session, TransferRig{"hero.glb"});
  ASSERT_EQ(session.state().movement.clips.size(), 1u);
  perform(session, SetTime{0.3});
  const std::vector<Vec3f> after = posedPositions(*session.state().rig, session.state().pose);
  ASSERT_EQ(before.size(), after.size());
  double sum = 0;
  for (std::size_t v = 0; v < before.size(); ++v) sum += (before[v] - after[v]).norm();
  EXPECT_LT(sum / static_cast<double>(before.size()), 0.05);
}

TEST(TakenRig, BytesAtHandAreTheSameAsTheCommand) {
  Session session = openedModel("giant.glb");
  perform(session, TransferRig{"hero.glb"});
  SessionScene scene(rigFiles);
  Progress progress;
  scene.run(OpenFile{"giant.glb"}, progress);
  scene.transferRig(heroGlb(), TransferRig{"hero.glb"}, progress);
  EXPECT_EQ(scene.exportModel(ExportFormat::kGlb), session.exportModel(ExportFormat::kGlb));
  EXPECT_EQ(commandsToJson(scene.record()), commandsToJson(session.record()));
}

TEST(TakenRig, ABodyInSmplsLayoutServesAsAModel) {
  Session session = openedModel("giant.glb");
  const std::vector<Affine> oldTransforms = restGlobals(session.state().rig->skeleton());
  perform(session, TransferRig{"person.npz"});
  const std::vector<Affine> transforms = restGlobals(session.state().rig->skeleton());
  ASSERT_EQ(transforms.size(), oldTransforms.size());
  for (std::size_t j = 0; j < transforms.size(); ++j) {
    EXPECT_LT((transforms[j].translation() - oldTransforms[j].translation()).norm(), 0.05) << j;
  }
}

TEST(TakenRig, WhatCannotBeTakenChangesNothing) {
  Session session = openedModel("giant.glb");
  const Bytes before = session.exportModel(ExportFormat::kGlb);
  EXPECT_EQ(refusalKindOf(session, TransferRig{"biped.glb"}), ErrorKind::kNoRig);
  EXPECT_EQ(refusalKindOf(session, RigFromAnimation{}), ErrorKind::kNoAnimation);
  EXPECT_THROW(perform(session, TransferRig{"none.glb"}), Error);
  EXPECT_THROW(perform(session, TransferRig{"walk.bvh"}), Error);
  EXPECT_EQ(session.exportModel(ExportFormat::kGlb), before);
  EXPECT_EQ(session.record().size(), 1u);
  Session empty(rigFiles);
  EXPECT_EQ(refusalKindOf(empty, TransferRig{"hero.glb"}), ErrorKind::kNoModel);
  perform(session, BeginDrag{"head", DragMode::kMove, {{0, 2, 5}, {0, 0, -1}}});
  EXPECT_EQ(refusalKindOf(session, TransferRig{"hero.glb"}), ErrorKind::kJointDragged);
  EXPECT_EQ(refusalKindOf(session, RigFromAnimation{}), ErrorKind::kJointDragged);
}

TEST(TakenRig, BonesOfTheAnimationMoveTheSurfaceAsTheFileDoes) {
  Session session = openedModel("walker.glb");
  EXPECT_EQ(sessionState(session)["animated"], true);
  perform(session, ChooseClip{"walk"});
  perform(session, SetTime{0.4});
  const std::vector<Vec3f> wanted = posedPositions(*session.state().rig, session.state().pose);
  perform(session, RigFromAnimation{24});
  const Movement& movement = session.state().movement;
  ASSERT_EQ(movement.clips.size(), 1u);
  EXPECT_EQ(movement.clip()->name, "walk");
  EXPECT_LE(session.state().rig->skeleton().jointCount(), 24u);
  perform(session, SetTime{0.4});
  const std::vector<Vec3f> found = posedPositions(*session.state().rig, session.state().pose);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t v = 0; v < found.size(); ++v) ASSERT_LT((found[v] - wanted[v]).norm(), 0.01) << v;
  const Bytes made = session.exportModel(ExportFormat::kGlb);
  Session replayed(rigFiles);
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) perform(replayed, command);
  EXPECT_EQ(replayed.exportModel(ExportFormat::kGlb), made);
  perform(session, Undo{});
  EXPECT_THAT(jointNames(session), ::testing::Contains("head"));
}

TEST(TakenRig, ItsOwnClipsTakeThePlaceOfThoseOfTheirNames) {
  Session session = openedModel("walker.glb");
  perform(session, AddClip{"wave"});
  perform(session, RigFromAnimation{8});
  std::vector<std::string> names;
  for (const SessionClip& clip : session.state().movement.clips) names.push_back(clip.clip->name);
  EXPECT_THAT(names, ElementsAre("walk", "wave"));
  EXPECT_EQ(session.state().movement.clips[0].clip, session.state().rig->clips[0]);
  EXPECT_THROW(perform(session, RigFromAnimation{100000}), Error);
}

}  // namespace
}  // namespace limber
