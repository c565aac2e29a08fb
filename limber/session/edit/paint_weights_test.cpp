#include "limber/session/edit/paint_weights.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/document/read.h"
#include "limber/session/session.h"
#include "limber/session/session_state.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

std::optional<Bytes> personFile(std::string_view path) {
  return path == "person.glb" ? std::optional<Bytes>(testing::namedPersonGlb()) : std::nullopt;
}

void carryOut(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

Session personToPaint() {
  Session session(personFile);
  carryOut(session, OpenFile{"person.glb"});
  return session;
}

const SkinWeights& weightsOf(const Session& session) {
  return session.state().rig->weights;
}

double weightAt(const SkinWeights& weights, Index vertex, Index joint) {
  double sum = 0;
  for (Index k = 0; k < weights.slots; ++k) {
    if (weights.jointsOf(vertex)[k] == joint) sum += weights.weightsOf(vertex)[k];
  }
  return sum;
}

void expectWhole(const SkinWeights& weights) {
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    double sum = 0;
    for (const float weight : weights.weightsOf(v)) sum += weight;
    ASSERT_NEAR(sum, 1, 1e-6) << v;
  }
}

Index jointOf(const Session& session, const char* name) {
  return *session.state().rig->skeleton().find(name);
}

// A triangle of the surface that this joint moves.
Index triangleOn(const Session& session, Index joint) {
  const RiggedModel& rig = *session.state().rig;
  for (Index t = 0; t < rig.geometry().triangles.size(); ++t) {
    if (weightAt(rig.weights, rig.geometry().triangles[t][0], joint) > 0.5) return t;
  }
  throw Error(ErrorCode::kBadArgument, "the joint holds nothing");
}

PaintWeights stroke(const Session& session, const char* joint, const char* where, PaintMode mode = PaintMode::kAdd) {
  PaintWeights paint;
  paint.joint = joint;
  paint.mode = mode;
  paint.strength = 0.6;
  paint.radius = 0.3;
  const Index triangle = triangleOn(session, jointOf(session, where));
  paint.dabs = {{triangle, 0.2, 0.3}, {triangle, 0.3, 0.2}};
  return paint;
}

TEST(PaintWeights, AStrokeIsOneStepAndUndoneExactly) {
  Session session = personToPaint();
  const SkinWeights before = weightsOf(session);
  const PaintWeights paint = stroke(session, "head", "leftUpperArm");
  const SkinWeights seen = session.previewPaint(paint);
  EXPECT_EQ(weightsOf(session).weights, before.weights) << "a preview changes nothing";
  carryOut(session, paint);
  EXPECT_EQ(weightsOf(session).weights, seen.weights);
  EXPECT_EQ(weightsOf(session).joints, seen.joints);
  EXPECT_NE(weightsOf(session).weights, before.weights);
  expectWhole(weightsOf(session));
  EXPECT_EQ(session.undoName(), "paint_weights");
  carryOut(session, Undo{});
  EXPECT_EQ(weightsOf(session).weights, before.weights);
  EXPECT_EQ(weightsOf(session).joints, before.joints);
}

TEST(PaintWeights, APreviewThatGrowsIsTheWholeStroke) {
  Session session = personToPaint();
  PaintWeights paint = stroke(session, "head", "leftUpperArm", PaintMode::kSmooth);
  const std::vector<SurfaceDab> dabs = paint.dabs;
  paint.dabs.pop_back();
  session.previewPaint(paint);
  paint.dabs = dabs;
  const SkinWeights grown = session.previewPaint(paint);
  carryOut(session, paint);
  EXPECT_EQ(weightsOf(session).weights, grown.weights);
}

TEST(PaintWeights, LockedJointsKeepEveryBit) {
  Session session = personToPaint();
  carryOut(session, stroke(session, "head", "leftUpperArm"));
  const SkinWeights before = weightsOf(session);
  const Index arm = jointOf(session, "leftUpperArm");
  carryOut(session, LockWeights{"leftUpperArm", true});
  EXPECT_THROW(carryOut(session, stroke(session, "leftUpperArm", "leftUpperArm")), Error);
  carryOut(session, stroke(session, "hips", "leftUpperArm"));
  for (Index v = 0; v < before.vertexCount(); ++v) {
    ASSERT_EQ(static_cast<float>(weightAt(weightsOf(session), v, arm)), static_cast<float>(weightAt(before, v, arm)));
  }
  EXPECT_NE(weightsOf(session).weights, before.weights) << "the head gives";
  expectWhole(weightsOf(session));
  EXPECT_EQ(sessionState(session)["locked"], Json::array({arm}));
  carryOut(session, LockWeights{"leftUpperArm", false});
  EXPECT_TRUE(session.state().locked.empty());
}

TEST(PaintWeights, SeamsGetEqualWeights) {
  Session session = personToPaint();
  carryOut(session, stroke(session, "head", "leftUpperArm"));
  const RiggedModel& rig = *session.state().rig;
  const PaintSurface surface(rig.character.sharedSurface());
  for (Index w = 0; w < surface.distance().mesh().vertexCount(); ++w) {
    for (const Index source : surface.sources(w)) {
      for (Index j = 0; j < rig.skeleton().jointCount(); ++j) {
        ASSERT_EQ(weightAt(rig.weights, source, j), weightAt(rig.weights, surface.sources(w).front(), j));
      }
    }
  }
}

// Two triangles of grids of their own: a welded vertex takes the position of its lowest source.
TEST(PaintSurface, APlaceIsThatOfItsLowestVertex) {
  auto geometry = std::make_shared<Geometry>();
  geometry->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1.01f, 0, 0}, {1, 1, 0}, {0, 1.01f, 0}};
  geometry->triangles = {{0, 1, 2}, {3, 4, 5}};
  for (const Index part : {0, 1}) {
    PrimitiveInstance& instance = geometry->instances.emplace_back();
    instance.firstVertex = 3 * part;
    instance.vertexCount = 3;
    instance.quantisation = 0.02;
  }
  const PaintSurface surface(geometry);
  const TriMesh& mesh = surface.distance().mesh();
  ASSERT_EQ(mesh.vertexCount(), 4u);
  for (Index w = 0; w < 4; ++w) EXPECT_EQ(mesh.positions[w], geometry->positions[surface.sources(w).front()]) << w;
}

TEST(PaintWeights, BothSidesArePaintedAlike) {
  Session session = personToPaint();
  PaintWeights paint = stroke(session, "leftUpperArm", "leftLowerArm", PaintMode::kReplace);
  paint.mirrored = true;
  carryOut(session, paint);
  const RiggedModel& rig = *session.state().rig;
  const PaintSurface surface(rig.character.sharedSurface());
  ASSERT_TRUE(surface.mirror());
  const Index left = jointOf(session, "leftUpperArm"), right = jointOf(session, "rightUpperArm");
  double most = 0;
  for (Index w = 0; w < surface.mirror()->image.size(); ++w) {
    const Index here = surface.sources(w).front(), there = surface.sources(surface.mirror()->image[w]).front();
    EXPECT_NEAR(weightAt(rig.weights, here, left), weightAt(rig.weights, there, right), 1e-6);
    most = std::max(most, weightAt(rig.weights, here, right));
  }
  EXPECT_GT(most, 0.3);
}

TEST(PaintWeights, OneSideCanBeTakenForTheOther) {
  Session session = personToPaint();
  carryOut(session, stroke(session, "head", "leftUpperArm"));
  carryOut(session, MirrorWeights{MirrorFrom::kLeft});
  const RiggedModel& rig = *session.state().rig;
  expectWhole(rig.weights);
  const PaintSurface surface(rig.character.sharedSurface());
  const RigMirror mirror = mirrorOfRig(rig, surface.mirror()->plane);
  for (Index w = 0; w < surface.mirror()->image.size(); ++w) {
    const Index here = surface.sources(w).front(), there = surface.sources(surface.mirror()->image[w]).front();
    for (Index j = 0; j < mirror.joints.size(); ++j) {
      if (mirror.joints[j] == kNoIndex) continue;
      EXPECT_NEAR(weightAt(rig.weights, here, j), weightAt(rig.weights, there, mirror.joints[j]), 1e-6);
    }
  }
  EXPECT_THROW(carryOut(session, MirrorWeights{MirrorFrom::kBoth}), Error);
}

TEST(PaintWeights, ARecordGivesTheSameBytesAndTheFileTheSameWeights) {
  Session session = personToPaint();
  carryOut(session, stroke(session, "head", "leftUpperArm"));
  carryOut(session, stroke(session, "", "leftUpperArm", PaintMode::kSmooth));
  carryOut(session, LockWeights{"head", true});
  const Bytes bytes = session.exportModel(ExportFormat::kGlb);
  Session again(personFile);
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) carryOut(again, command);
  EXPECT_EQ(again.exportModel(ExportFormat::kGlb), bytes);

  const Asset written = readAsset(bytes, "painted.glb");
  checkAsset(written);
  const std::shared_ptr<const RiggedModel> reopened = openRiggedModel(written);
  const SkinWeights& weights = weightsOf(session);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    for (Index j = 0; j < reopened->skeleton().jointCount(); ++j) {
      ASSERT_NEAR(weightAt(reopened->weights, v, j), weightAt(weights, v, j), 1e-6) << v;
    }
  }

  Session restored;
  Progress progress;
  restored.open(session.saveSession(), "kept.glb", progress);
  EXPECT_TRUE(restored.state().locked.count("head"));
  EXPECT_NEAR(weightAt(weightsOf(restored), 0, 0), weightAt(weights, 0, 0), 1e-6);
}

TEST(PaintWeights, ARigMadeByMethodsIsKeptWithItsPaint) {
  Session session([](std::string_view) { return std::optional<Bytes>(testing::bipedGlb()); });
  carryOut(session, OpenFile{"biped.glb"});
  PaintWeights paint;
  paint.joint = session.state().rig->skeleton().joints[2].name;
  paint.radius = 0.4;
  paint.strength = 1;
  paint.dabs = {{0, 0.3, 0.3}};
  carryOut(session, paint);
  EXPECT_TRUE(sessionState(session)["edited_rig"].get<bool>());
  Session restored;
  Progress progress;
  restored.open(session.saveSession(), "kept.glb", progress);
  const SkinWeights &a = weightsOf(session), &b = weightsOf(restored);
  for (Index v = 0; v < a.vertexCount(); ++v) ASSERT_NEAR(weightAt(a, v, 2), weightAt(b, v, 2), 1e-6);
}

TEST(PaintWeights, ManyStrokesCanBeUndone) {
  Session session = personToPaint();
  const SkinWeights before = weightsOf(session);
  PaintWeights paint = stroke(session, "head", "leftUpperArm");
  paint.strength = 0.1;
  int steps = 0;
  for (int i = 0; i < 20; ++i) carryOut(session, paint);
  for (; session.undoName() == "paint_weights"; ++steps) carryOut(session, Undo{});
  EXPECT_GE(steps, 9) << "until the joint has all of it";
  EXPECT_EQ(weightsOf(session).weights, before.weights);
}

// Two copies of the person, one a millimetre before the other, as one model.
TEST(PaintWeights, TheBrushDoesNotReachASheetBehind) {
  const Session session = personToPaint();
  auto rig = std::make_shared<RiggedModel>(*session.state().rig);
  Geometry both = rig->geometry();
  const auto count = static_cast<Index>(both.positions.size());
  const std::size_t triangles = both.triangles.size();
  for (Index v = 0; v < count; ++v) both.positions.push_back(both.positions[v] + Vec3f(0, 0, 0.001f));
  for (std::size_t t = 0; t < triangles; ++t) {
    const Triangle corners = both.triangles[t];
    both.triangles.push_back({corners[0] + count, corners[1] + count, corners[2] + count});
  }
  SkinWeights& weights = rig->weights;
  const SkinWeights& own = session.state().rig->weights;
  weights.joints.insert(weights.joints.end(), own.joints.begin(), own.joints.end());
  weights.weights.insert(weights.weights.end(), own.weights.begin(), own.weights.end());
  const PaintSurface surface(std::make_shared<const Geometry>(std::move(both)));
  WeightStroke brush(*rig, surface, std::vector<bool>(rig->skeleton().jointCount(), false),
                     stroke(session, "head", "leftUpperArm"));
  brush.add(stroke(session, "head", "leftUpperArm").dabs);
  const SkinWeights painted = brush.weights();
  const std::size_t half = weights.weights.size() / 2;
  EXPECT_FALSE(std::equal(painted.weights.begin(), painted.weights.begin() + static_cast<std::ptrdiff_t>(half),
                          weights.weights.begin()));
  EXPECT_TRUE(std::equal(painted.weights.begin() + static_cast<std::ptrdiff_t>(half), painted.weights.end(),
                         weights.weights.begin() + static_cast<std::ptrdiff_t>(half)));
}

TEST(PaintWeights, WhatMakesNoSenseChangesNothing) {
  Session session = personToPaint();
  PaintWeights paint = stroke(session, "head", "leftUpperArm");
  const auto refused = [&](auto change) {
    PaintWeights bad = paint;
    change(bad);
    EXPECT_THROW(carryOut(session, bad), Error);
    EXPECT_THROW(session.previewPaint(bad), Error);
  };
  refused([](PaintWeights& bad) { bad.joint = "tail"; });
  refused([](PaintWeights& bad) { bad.strength = 1.5; });
  refused([](PaintWeights& bad) { bad.radius = 0; });
  refused([](PaintWeights& bad) { bad.dabs[1].triangle = 1'000'000; });
  refused([](PaintWeights& bad) { bad.dabs[1].u = 1.5; });
  EXPECT_FALSE(session.canUndo());
  paint.dabs.clear();
  carryOut(session, paint);
  EXPECT_FALSE(session.canUndo());
}

TEST(PaintWeights, TheBrushFindsTheSurfaceAsItStands) {
  Session session = personToPaint();
  carryOut(session, testing::turnedBy("hips", Vec3::UnitY(), 180));
  const std::optional<SurfaceHit> hit = session.pickSurface({Vec3(0, 1, 10), Vec3(0, 0, -1)});
  ASSERT_TRUE(hit);
  const RiggedModel& rig = *session.state().rig;
  const std::vector<Vec3f> posed = posedPositions(rig, session.state().pose);
  const Triangle& t = rig.geometry().triangles[hit->dab.triangle];
  const Vec3 at = (1 - hit->dab.u - hit->dab.v) * posed[t[0]].cast<double>() + hit->dab.u * posed[t[1]].cast<double>() +
                  hit->dab.v * posed[t[2]].cast<double>();
  EXPECT_LT((at - hit->position).norm(), 1e-6);
  EXPECT_GT(hit->normal.z(), 0.9);
  EXPECT_FALSE(session.pickSurface({Vec3(0, 50, 10), Vec3(0, 0, -1)}));
}

}  // namespace
}  // namespace limber
