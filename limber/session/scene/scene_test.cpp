#include "limber/session/scene/scene.h"

#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/session/scene/scene_layout.h"
#include "limber/session/scene/scene_state.h"
#include "limber/session/session_state.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::optional<Bytes> sceneFiles(std::string_view path) {
  if (path == "biped.glb") return testing::bipedGlb();
  if (path == "person.glb") return testing::namedPersonGlb();
  return path == "walk.bvh" ? std::optional<Bytes>(testing::walkBvh()) : std::nullopt;
}

void run(SessionScene& scene, const Command& command) {
  Progress progress;
  scene.run(command, progress);
}

// The chosen member does; its clip lasts a second.
void walk(SessionScene& scene) {
  run(scene, AddMotion{"walk.bvh"});
  RetargetMotion retarget;
  retarget.motion = "walk";
  run(scene, retarget);
}

// Two people with named joints and a block of a prop; the prop is chosen.
SessionScene twoAndAProp() {
  SessionScene scene(sceneFiles);
  run(scene, OpenFile{"person.glb"});
  run(scene, AddFile{"person.glb"});
  run(scene, AddFile{"biped.glb", false, true});
  return scene;
}

std::vector<std::string> namesOf(const SessionScene& scene) {
  std::vector<std::string> names;
  for (const SceneMember& member : scene.members()) names.push_back(member.name);
  return names;
}

const SessionState& stateOf(const SessionScene& scene, std::size_t member) {
  return scene.members()[member].session->state();
}

std::string leafOf(const SessionScene& scene, std::size_t member) {
  return stateOf(scene, member).rig->skeleton().joints.back().name;
}

double distanceOf(const Affine& a, const Affine& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(SessionScene, OfOneModelIsAsASession) {
  const std::vector<Command> commands = {OpenFile{"biped.glb"},
                                         SetHandles{5},
                                         SetHandles{8},
                                         testing::turnedBy("handle_02", {0, 0, 1}, 20),
                                         Undo{},
                                         Redo{}};
  SessionScene scene(sceneFiles);
  Session session(sceneFiles);
  Progress progress;
  for (const Command& command : commands) {
    try {
      session.run(command, progress);
    } catch (const Error&) {  // handles may have other names
      EXPECT_THROW(scene.run(command, progress), Error);
      continue;
    }
    scene.run(command, progress);
  }
  EXPECT_EQ(commandsToJson(scene.record()), commandsToJson(session.record()));
  EXPECT_EQ(scene.exportModel(ExportFormat::kGlb), session.exportModel(ExportFormat::kGlb));
  EXPECT_EQ(scene.undoName(), session.undoName());
  Json alone = sceneState(scene);
  EXPECT_EQ(alone["members"].size(), 1u);
  alone.erase("members");
  alone.erase("member");
  EXPECT_EQ(alone, sessionState(session));
}

TEST(SessionScene, ClipsWithoutNamesAreSavedByThoseOfTheSession) {
  SessionScene scene(sceneFiles);
  run(scene, OpenFile{"person.glb"});
  walk(scene);
  Asset asset = readAsset(scene.exportModel(ExportFormat::kGlb), "person.glb");
  std::vector<gltf::Animation>& animations = asset.document.animations;
  animations.push_back(animations.front());
  for (gltf::Animation& animation : animations) animation.name.clear();
  const Bytes unnamed = writeGlb(asset);
  SessionScene again([&](std::string_view) { return std::optional<Bytes>(unnamed); });
  run(again, OpenFile{"unnamed.glb"});
  WriteModelOptions options;
  options.clip = "clip 2";
  const Bytes text = again.saveModel(".usda", options).bytes;
  EXPECT_THAT(std::string(text.begin(), text.end()), HasSubstr("timeSamples"));
}

TEST(SessionScene, MembersStandBesideEachOtherOnOneGround) {
  const SessionScene scene = twoAndAProp();
  EXPECT_THAT(namesOf(scene), ElementsAre("person", "person 2", "biped"));
  EXPECT_EQ(scene.chosen(), 2u);
  EXPECT_EQ(stateOf(scene, 2).rig->skeleton().jointCount(), 1u);
  for (std::size_t m = 1; m < 3; ++m) {
    const Box before = boxOf(*scene.members()[m - 1].session, scene.toScene(m - 1));
    const Box box = boxOf(*scene.members()[m].session, scene.toScene(m));
    EXPECT_GT(box.min.x(), before.max.x());
    EXPECT_NEAR(box.min.y(), before.min.y(), 1e-6);
  }
}

TEST(SessionScene, UndoGoesBackThroughTheStepsOfAllMembers) {
  SessionScene scene = twoAndAProp();
  const Bytes begun = scene.exportModel(ExportFormat::kGlb);
  const std::string leaf = leafOf(scene, 0);
  run(scene, ChooseMember{"person"});
  run(scene, testing::turnedBy(leaf, {0, 0, 1}, 30));
  run(scene, ChooseMember{"person 2"});
  run(scene, testing::turnedBy(leaf, {0, 1, 0}, 40));
  run(scene, PlaceMember{"biped", {2, 0, 1}, {0, 45, 0}, 0.5});
  run(scene, ChooseMember{"person"});
  run(scene, testing::turnedBy(leaf, {1, 0, 0}, 10));
  const Bytes done = scene.exportModel(ExportFormat::kGlb);
  EXPECT_EQ(scene.undoName(), "set_turn");
  run(scene, Undo{});
  EXPECT_EQ(scene.undoName(), "place_member");
  run(scene, Undo{});
  run(scene, Undo{});
  EXPECT_EQ(scene.members()[scene.chosen()].name, "person 2");
  run(scene, Undo{});
  EXPECT_EQ(scene.members()[scene.chosen()].name, "person");
  EXPECT_EQ(scene.exportModel(ExportFormat::kGlb), begun);
  for (int i = 0; i < 4; ++i) run(scene, Redo{});
  EXPECT_EQ(scene.exportModel(ExportFormat::kGlb), done);
  EXPECT_FALSE(scene.canRedo());
  run(scene, Undo{});
  run(scene, RenameMember{"biped", "block"});
  EXPECT_FALSE(scene.canRedo());
}

TEST(SessionScene, ARemovedMemberComesBackWhole) {
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 1);
  run(scene, AttachMember{"biped", "person 2", leaf});
  run(scene, ChooseMember{"person 2"});
  run(scene, testing::turnedBy(leaf, {0, 0, 1}, 25));
  const Bytes before = scene.exportModel(ExportFormat::kGlb);
  const Affine attachedTransform = scene.toScene(2);
  run(scene, RemoveMember{"person 2"});
  EXPECT_THAT(namesOf(scene), ElementsAre("person", "biped"));
  EXPECT_LT(distanceOf(scene.toScene(1), attachedTransform), 1e-6);
  run(scene, Undo{});
  EXPECT_EQ(scene.exportModel(ExportFormat::kGlb), before);
  run(scene, Undo{});  // the pose that it had before it was removed
  EXPECT_NE(scene.exportModel(ExportFormat::kGlb), before);
  run(scene, Redo{});
  EXPECT_EQ(scene.exportModel(ExportFormat::kGlb), before);
}

TEST(SessionScene, WhatIsAttachedFollowsItsJoint) {
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 0);
  run(scene, PlaceMember{"person", {0.3, 0, -1}, {0, 30, 0}, 1.5});
  const Affine before = scene.toScene(2);
  run(scene, AttachMember{"biped", "person", leaf});
  EXPECT_LT(distanceOf(scene.toScene(2), before), 1e-9);
  const auto frame = [&] { return scene.toScene(0) * jointFrame(stateOf(scene, 0), leaf); };
  const Affine offset = frame().inverse() * before;
  run(scene, ChooseMember{"person"});
  run(scene, testing::turnedBy(stateOf(scene, 0).rig->skeleton().joints[0].name, {0.3, 1, 0}, 70));
  EXPECT_GT(distanceOf(scene.toScene(2), before), 0.1);
  EXPECT_LT(distanceOf(scene.toScene(2), frame() * offset), 1e-6);
  // Through a clip, too.
  walk(scene);
  run(scene, SetClock{1.25});
  EXPECT_NEAR(stateOf(scene, 0).movement.seconds, 0.25, 1e-9);
  EXPECT_LT(distanceOf(scene.toScene(2), frame() * offset), 1e-6);
  const Affine let = scene.toScene(2);
  run(scene, DetachMember{"biped"});
  EXPECT_LT(distanceOf(scene.toScene(2), let), 1e-6);
  run(scene, SetClock{0.5});
  EXPECT_LT(distanceOf(scene.toScene(2), let), 1e-6);
}

TEST(SessionScene, SnappedTheMiddleIsAtTheJoint) {
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 0);
  run(scene, AttachMember{"biped", "person", leaf, true});
  const Vec3 joint = (scene.toScene(0) * jointFrame(stateOf(scene, 0), leaf)).translation();
  EXPECT_LT((boxOf(*scene.members()[2].session, scene.toScene(2)).center() - joint).norm(), 1e-6);
  run(scene, PlaceMember{"biped", {1, 2, 3}, {0, 0, 90}, 0.25});
  EXPECT_TRUE(scene.members()[2].attachment);
  EXPECT_LT((scene.toScene(2).translation() - Vec3(1, 2, 3)).norm(), 1e-6);
}

TEST(SessionScene, AnAttachmentLivesThroughChangesOfTheRig) {
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 0);
  run(scene, AttachMember{"biped", "person", leaf});
  const Affine before = scene.toScene(2);
  run(scene, ChooseMember{"person"});
  run(scene, RenameJoint{leaf, "paw"});
  EXPECT_EQ(scene.members()[2].attachment->joint, "paw");
  EXPECT_LT(distanceOf(scene.toScene(2), before), 1e-6);
  run(scene, Undo{});
  EXPECT_EQ(scene.members()[2].attachment->joint, leaf);
  run(scene, Redo{});
  run(scene, SetHandles{12});
  EXPECT_LT(distanceOf(scene.toScene(2), before), 1e-5);
  run(scene, SetHandles{15});
  EXPECT_LT(distanceOf(scene.toScene(2), before), 1e-5);
  run(scene, Undo{});
  EXPECT_EQ(scene.members()[2].attachment->joint, "paw");
  EXPECT_LT(distanceOf(scene.toScene(2), before), 1e-6);
}

TEST(SessionScene, ARecordDoneAgainGivesTheSameBytes) {
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 0);
  run(scene, AttachMember{"biped", "person", leaf, true});
  run(scene, ChooseMember{"biped"});
  run(scene, ChooseMember{"person"});
  run(scene, BeginDrag{leaf, DragMode::kTurn, {{0, 1, 10}, {0, 0, -1}}});
  run(scene, TurnDrag{{0, 0, 1}, 10});
  run(scene, TurnDrag{{0, 0, 1}, 35});
  run(scene, EndDrag{});
  walk(scene);
  run(scene, SetClock{0.2});
  run(scene, SetClock{0.4});
  run(scene, RemoveMember{"person 2"});
  run(scene, Undo{});
  EXPECT_EQ(std::count_if(scene.record().begin(), scene.record().end(),
                          [](const Command& c) { return std::holds_alternative<SetClock>(c); }),
            1);
  const std::string record = commandsToJson(scene.record());
  SessionScene again(sceneFiles);
  for (const Command& command : commandsFromJson(record)) run(again, command);
  EXPECT_EQ(commandsToJson(again.record()), record);
  EXPECT_EQ(again.exportModel(ExportFormat::kGlb), scene.exportModel(ExportFormat::kGlb));
  EXPECT_EQ(sceneState(again), sceneState(scene));
}

TEST(SessionScene, OneFileHoldsAllMembers) {
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 0);
  run(scene, AttachMember{"biped", "person", leaf, true});
  for (const char* name : {"person", "person 2"}) {
    run(scene, ChooseMember{name});
    walk(scene);
  }
  run(scene, SetClock{0.3});
  const Bytes glb = scene.exportModel(ExportFormat::kGlb);
  const Asset asset = readAsset(glb, "scene.glb");
  checkAsset(asset);
  const gltf::Document& document = asset.document;
  EXPECT_EQ(document.skins.size(), 3u);
  EXPECT_EQ(document.animations.size(), 2u);
  EXPECT_EQ(document.scenes.size(), 1u);
  std::set<std::string> names;
  for (const gltf::Node& node : document.nodes) {
    EXPECT_TRUE(node.name.empty() || names.insert(node.name).second) << node.name;
  }
  // Each vertex is where the scene shows it, and the prop hangs on its joint.
  const Geometry geometry = collectGeometry(asset);
  std::size_t found = 0;
  const SceneGraph graph = readSceneGraph(document);
  for (Index node = 0; node < graph.nodeCount(); ++node) {
    if (document.nodes[node].name != "biped") continue;
    ++found;
    EXPECT_LT(distanceOf(graph.world[node], scene.toScene(2)), 1e-5);
    EXPECT_EQ(document.nodes[*graph.parent[node]].name, leaf);
  }
  EXPECT_EQ(found, 1u);
  std::size_t vertices = 0;
  for (std::size_t m = 0; m < 3; ++m) vertices += stateOf(scene, m).rig->geometry().positions.size();
  EXPECT_EQ(geometry.positions.size(), vertices);
}

TEST(SessionScene, ASurfaceInFrontIsPicked) {
  SessionScene scene = twoAndAProp();
  const Box box = boxOf(*scene.members()[1].session, scene.toScene(1));
  run(scene, ChooseMember{"person"});
  // The first one is at the origin: its space is the scene's.
  const std::optional<SceneHit> hit = scene.pick({box.center() + Vec3(0, 0, 10), {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->member, 1u);
  EXPECT_FALSE(scene.pick({{0, 100, 10}, {0, 0, -1}}));
}

TEST(SessionScene, WhatCannotBeDoneChangesNothing) {
  SessionScene empty(sceneFiles);
  EXPECT_THROW(run(empty, AddFile{"biped.glb"}), Error);
  EXPECT_THROW(run(empty, RemoveMember{"person"}), Error);
  EXPECT_TRUE(empty.record().empty());
  SessionScene scene = twoAndAProp();
  const std::string leaf = leafOf(scene, 0);
  run(scene, AttachMember{"biped", "person", leaf});
  const Json before = sceneState(scene);
  const std::string record = commandsToJson(scene.record());
  for (const Command& wrong : std::vector<Command>{
           RemoveMember{"nobody"}, ChooseMember{"nobody"}, RenameMember{"biped", "person"}, RenameMember{"biped", ""},
           PlaceMember{"biped", {0, 0, 0}, {0, 0, 0}, 0}, AttachMember{"biped", "person", "no joint"},
           AttachMember{"person", "biped", "prop"}, AttachMember{"biped", "biped", "prop"}, DetachMember{"person"},
           AddFile{"nothing.glb"}, OpenFile{"nothing.glb"}, Redo{}}) {
    EXPECT_THROW(run(scene, wrong), Error) << commandName(wrong);
  }
  run(scene, BeginDrag{"prop", DragMode::kMove, {}});
  EXPECT_THROW(run(scene, ChooseMember{"person"}), Error);
  EXPECT_THROW(run(scene, Undo{}), Error);
  run(scene, CancelDrag{});
  EXPECT_EQ(sceneState(scene), before);
  EXPECT_EQ(commandsToJson(scene.record()), record);
  Session session(sceneFiles);
  Progress progress;
  session.run(OpenFile{"biped.glb"}, progress);
  EXPECT_THROW(session.run(RemoveMember{"biped"}, progress), Error);
  EXPECT_THROW(session.run(AddFile{"biped.glb"}, progress), Error);
}

TEST(SessionScene, APropBecomesPosableByAskingForHandles) {
  SessionScene scene = twoAndAProp();
  run(scene, SetHandles{8});
  EXPECT_EQ(stateOf(scene, 2).rig->skeleton().jointCount(), 8u);
  EXPECT_EQ(stateOf(scene, 2).rigger, "sphere-mesh");
  run(scene, Undo{});
  EXPECT_EQ(stateOf(scene, 2).rig->skeleton().jointCount(), 1u);
}

TEST(SessionScene, SeveralSurfacesGoIntoOneMesh) {
  SessionScene scene = twoAndAProp();
  const Bytes stl = scene.exportModel(ExportFormat::kStl);
  std::size_t triangles = 0;
  for (std::size_t m = 0; m < 3; ++m) triangles += stateOf(scene, m).rig->geometry().triangles.size();
  EXPECT_EQ(stl.size(), 84 + 50 * triangles);
  EXPECT_GT(scene.exportModel(ExportFormat::kUsdz).size(), 0u);
}

}  // namespace
}  // namespace limber
