// The deformer that is chosen bends everything that is made of the posed surface, and nothing of the rig.
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/actions/pose/pose_asset.h"
#include "limber/core/error.h"
#include "limber/document/rig/pose_io.h"
#include "limber/session/drag/measures.h"
#include "limber/session/scene/scene.h"
#include "limber/session/session.h"
#include "limber/session/session_state.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

std::optional<Bytes> bipedFiles(std::string_view path) {
  return path == "biped.glb" ? std::optional<Bytes>(testing::bipedGlb()) : std::nullopt;
}

void take(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

std::string jointName(const Session& session, Index joint) {
  return session.state().rig->skeleton().joints.at(joint).name;
}

// With its limbs bent at several joints.
Session bentBiped() {
  Session session;
  Progress progress;
  session.open(testing::bipedGlb(), "biped.glb", progress);
  take(session, SetHandles{16});
  for (const Index joint : {3u, 6u, 9u, 12u})
    take(session, testing::turnedBy(jointName(session, joint), {1, 0.5, 1}, 55));
  return session;
}

std::vector<Vec3f> verticesOf(const Bytes& obj) {
  std::istringstream lines(std::string(reinterpret_cast<const char*>(obj.data()), obj.size()));
  std::vector<Vec3f> vertices;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    Vec3f at;
    if (words >> kind && kind == "v" && words >> at.x() >> at.y() >> at.z()) vertices.push_back(at);
  }
  return vertices;
}

double farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max<double>(most, (a[v] - b[v]).norm());
  return most;
}

std::vector<Vec3f> exported(const Session& session) {
  return verticesOf(session.exportModel(ExportFormat::kObj));
}

TEST(SetDeformer, TheExportedSurfaceIsThatOfTheBakedModel) {
  Session session = bentBiped();
  const std::vector<Vec3f> linear = exported(session);
  const Bytes glb = session.exportModel(ExportFormat::kGlb);
  const Asset asset = readAsset(glb, "posed.glb");
  const AssetSkeleton skeleton = readSkeleton(asset);
  for (const Deformer& deformer : deformers()) {
    take(session, SetDeformer{std::string(deformer.name)});
    const std::vector<Vec3f> bent = exported(session);
    const auto baked = posedGeometry(asset, skeleton, readNodePose(asset, skeleton), deformer).geometry.positions;
    EXPECT_LT(farthest(bent, baked), 2e-5) << deformer.name;
    const bool isLinear = deformer.name == kLinearBlendDeformer.name;
    EXPECT_EQ(farthest(bent, linear) > 1e-3, !isLinear) << deformer.name;
    EXPECT_EQ(session.exportModel(ExportFormat::kGlb), glb) << "a GLB has weights alone";
    for (const ExportFormat format : {ExportFormat::kStl, ExportFormat::kPly}) {
      Session plain = bentBiped();
      EXPECT_EQ(session.exportModel(format) == plain.exportModel(format), isLinear);
    }
  }
}

TEST(SetDeformer, IsOneStepThatChangesNothingElse) {
  Session session = bentBiped();
  const Json before = sessionState(session);
  EXPECT_EQ(before["deformer"], "linear-blend");
  const auto rig = session.state().rig;
  take(session, SetDeformer{"delta-mush"});
  EXPECT_EQ(session.undoName(), "set_deformer");
  EXPECT_EQ(session.state().rig, rig);
  Json after = sessionState(session);
  EXPECT_EQ(after["deformer"], "delta-mush");
  for (const char* changed : {"deformer", "undo"}) after[changed] = before[changed];
  EXPECT_EQ(after, before);
  const std::vector<Vec3f> soft = exported(session);
  take(session, Undo{});
  EXPECT_EQ(session.state().deformer, "linear-blend");
  EXPECT_NE(exported(session), soft);
  take(session, Redo{});
  EXPECT_EQ(exported(session), soft);
  // Another rig is bent alike.
  take(session, SetHandles{9});
  EXPECT_EQ(session.state().deformer, "delta-mush");
}

TEST(SetDeformer, WhatIsNotThereIsRefused) {
  Session session = bentBiped();
  const std::size_t recorded = session.record().size();
  try {
    take(session, SetDeformer{"jelly"});
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("jelly"));
  }
  EXPECT_EQ(session.state().deformer, "linear-blend");
  EXPECT_EQ(session.record().size(), recorded);
  take(session, BeginDrag{jointName(session, 3), DragMode::kMove, {Vec3(0, 1, 10)}});
  EXPECT_THROW(take(session, SetDeformer{"delta-mush"}), Error);
}

TEST(SetDeformer, TheRecordAndTheSavedSessionHaveIt) {
  for (const Deformer& deformer : deformers()) {
    Session session(bipedFiles);
    take(session, OpenFile{"biped.glb"});
    take(session, SetDeformer{std::string(deformer.name)});
    take(session, testing::turnedBy(jointName(session, 1), {0, 0, 1}, 40));
    Session again(bipedFiles);
    for (const Command& command : commandsFromJson(commandsToJson(session.record()))) take(again, command);
    EXPECT_EQ(again.exportModel(ExportFormat::kObj), session.exportModel(ExportFormat::kObj)) << deformer.name;
    const Bytes saved = session.saveSession();
    Session reopened;
    Progress progress;
    reopened.open(saved, session.source().name, progress);
    EXPECT_EQ(reopened.state().deformer, deformer.name);
    EXPECT_EQ(reopened.exportModel(ExportFormat::kObj), session.exportModel(ExportFormat::kObj)) << deformer.name;
    EXPECT_EQ(reopened.saveSession(), saved);
  }
}

TEST(SetDeformer, AFileThatNamesNoneBlendsLinearlyAndABadNameIsRefused) {
  Session session = bentBiped();
  Progress progress;
  const auto savedWith = [&](const Json& deformer) {
    Asset asset = readAsset(session.saveSession(), "saved.glb");
    Json& kept = asset.document.extras.change()["limber_session"];
    EXPECT_FALSE(kept.contains("deformer")) << "as bipedFiles before this were";
    if (!deformer.is_null()) kept["deformer"] = deformer;
    return writeGlb(asset);
  };
  Session old;
  old.open(savedWith(nullptr), "old.glb", progress);
  EXPECT_EQ(old.state().deformer, "linear-blend");
  EXPECT_EQ(exported(old), exported(session));
  Session chosen;
  chosen.open(savedWith("dual-quaternion"), "chosen.glb", progress);
  EXPECT_EQ(chosen.state().deformer, "dual-quaternion");
  for (const Json& bad : {Json("jelly"), Json(7), Json("")}) {
    Session none;
    EXPECT_THROW(none.open(savedWith(bad), "bad.glb", progress), Error) << bad;
    EXPECT_FALSE(none.isOpen());
  }
}

TEST(SetDeformer, RaysMeetTheSurfaceThatItBends) {
  Session session = bentBiped();
  for (const Deformer& deformer : deformers()) {
    take(session, SetDeformer{std::string(deformer.name)});
    const std::vector<Vec3f> positions = exported(session);
    const std::vector<Triangle>& triangles = session.state().rig->geometry().triangles;
    int met = 0;
    for (const double height : {0.2, 0.7, 1.1, 1.5}) {
      const auto hit = session.pickSurface({Vec3(0.03, height, 10), Vec3(0, 0, -1)});
      if (!hit) continue;
      const Triangle& t = triangles[hit->dab.triangle];
      const Vec3 at = (1 - hit->dab.u - hit->dab.v) * positions[t[0]].cast<double>() +
                      hit->dab.u * positions[t[1]].cast<double>() + hit->dab.v * positions[t[2]].cast<double>();
      EXPECT_LT((at - hit->position).norm(), 1e-5) << deformer.name << " " << height;
      const auto pick = session.pick({Vec3(0.03, height, 10), Vec3(0, 0, -1)}, 0);
      ASSERT_TRUE(pick.has_value());
      EXPECT_TRUE(pick->onHandle || pick->position == hit->position) << deformer.name;
      ++met;
    }
    EXPECT_GE(met, 2) << deformer.name;
  }
}

TEST(SetDeformer, MeasuresAreOfTheSurfaceThatItBends) {
  Session session = bentBiped();
  const SessionMeasures linear = measureSession(session);
  take(session, SetDeformer{"direct-delta-mush"});
  const SessionMeasures soft = measureSession(session);
  EXPECT_NE(soft.volume, linear.volume);
  EXPECT_NE(soft.stretch, linear.stretch);
  EXPECT_EQ(soft.influences, linear.influences);
}

TEST(SetDeformer, PaintedWeightsArePreparedAnewAndOldOnesForgotten) {
  Session session = bentBiped();
  take(session, SetDeformer{"direct-delta-mush"});
  const std::vector<Vec3f> before = exported(session);
  const auto first = session.state().rig;
  EXPECT_EQ(first->preparations->size(), 1u);
  const std::string joint = jointName(session, 3);
  PaintWeights stroke{joint, PaintMode::kReplace, 1, 0.4, false, {}};
  for (Index t = 0; t < 24; ++t) stroke.dabs.push_back({t, 0.3, 0.3});
  take(session, stroke);
  ASSERT_NE(session.state().rig, first);
  EXPECT_EQ(first->preparations->size(), 0u);
  const std::vector<Vec3f> after = exported(session);
  EXPECT_GT(farthest(before, after), 1e-4);
  // As a rig that never had other weights bends.
  RiggedModel fresh = *session.state().rig;
  fresh.preparations = std::make_shared<DeformPreparations>();
  EXPECT_EQ(farthest(posedPositions(fresh, session.state().pose, findDeformer("direct-delta-mush")), after), 0);
  take(session, Undo{});
  EXPECT_EQ(exported(session), before);
  EXPECT_EQ(session.state().rig, first);
}

TEST(SetDeformer, ForksAndRenamedRigsShareWhatIsPrepared) {
  Session session = bentBiped();
  take(session, SetDeformer{"delta-mush"});
  exported(session);
  Session fork = session.fork();
  EXPECT_EQ(fork.state().deformer, "delta-mush");
  EXPECT_EQ(fork.state().rig->preparations, session.state().rig->preparations);
  take(session, RenameJoint{jointName(session, 2), "knee"});
  EXPECT_EQ(session.state().rig->preparations, fork.state().rig->preparations);
  EXPECT_EQ(session.state().rig->preparations->size(), 1u);
  EXPECT_EQ(exported(session), exported(fork));
}

TEST(SetDeformer, NormalsBendAlong) {
  Session session = bentBiped();
  const RiggedModel& rig = *session.state().rig;
  const std::vector<Vec3f> bound(rig.geometry().positions.size(), Vec3f::UnitY());
  for (const Deformer& deformer : deformers()) {
    const PosedSurface surface = posedSurface(rig, session.state().pose, deformer, bound);
    EXPECT_EQ(surface.positions, posedPositions(rig, session.state().pose, deformer));
    ASSERT_EQ(surface.normals.size(), bound.size());
    for (const Vec3f& normal : surface.normals) EXPECT_NEAR(normal.norm(), 1, 1e-4) << deformer.name;
    EXPECT_NE(surface.normals, bound) << deformer.name;
  }
}

TEST(SetDeformer, EachMemberOfASceneHasItsOwn) {
  SessionScene scene(bipedFiles);
  Progress progress;
  scene.run(OpenFile{"biped.glb"}, progress);
  scene.run(AddFile{"biped.glb"}, progress);
  scene.run(SetDeformer{"dual-quaternion"}, progress);
  EXPECT_EQ(scene.members()[0].session->state().deformer, "linear-blend");
  EXPECT_EQ(scene.members()[1].session->state().deformer, "dual-quaternion");
  const auto& skeleton = scene.session().state().rig->skeleton();
  for (const Index joint : {2u, 5u})
    scene.run(testing::turnedBy(skeleton.joints[joint].name, {0, 1, 0}, 100), progress);
  const std::vector<Vec3f> all = verticesOf(scene.exportModel(ExportFormat::kObj));
  scene.run(SetDeformer{"linear-blend"}, progress);
  const std::vector<Vec3f> linear = verticesOf(scene.exportModel(ExportFormat::kObj));
  const std::size_t first = scene.members()[0].session->state().rig->geometry().positions.size();
  ASSERT_GT(all.size(), first);
  for (std::size_t v = 0; v < first; ++v) EXPECT_EQ(all[v], linear[v]);
  EXPECT_NE(all, linear);
}

}  // namespace
}  // namespace limber
