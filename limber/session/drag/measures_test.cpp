#include "limber/session/drag/measures.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/session/testing/commands.h"
#include "limber/session/testing/models.h"

namespace limber {
namespace {

using testing::perform;

Session measured(Index handles) {
  Session session;
  Progress progress;
  session.open(testing::bipedGlb(), "biped.glb", progress);
  perform(session, SetHandles{handles});
  return session;
}

TEST(Measures, AModelAtRestIsNeitherStretchedNorFuller) {
  const SessionMeasures measures = measureSession(measured(20));
  EXPECT_EQ(measures.joints, 20U);
  EXPECT_GE(measures.influences, 1);
  EXPECT_LE(measures.influences, 4);
  EXPECT_GT(measures.smoothness, 0);
  EXPECT_LT(measures.smoothness, 2);
  EXPECT_LT(measures.stretch, 1e-5);
  EXPECT_LT(std::abs(measures.volume), 1e-4);
  EXPECT_FALSE(measures.targetDistance);
  EXPECT_FALSE(measures.motion);
  EXPECT_THROW(measureSession(Session()), Error);
}

TEST(Measures, OneHandleHoldsEverythingAlike) {
  Session session = measured(1);
  perform(session, testing::turnedBy(session.state().rig->skeleton().joints[0].name, Vec3(1, 1, 0), 60));
  const SessionMeasures measures = measureSession(session);
  EXPECT_EQ(measures.influences, 1);
  EXPECT_EQ(measures.smoothness, 0);
  EXPECT_LT(measures.stretch, 1e-5);  // it turned as a whole
  EXPECT_LT(std::abs(measures.volume), 1e-4);
}

TEST(Measures, ADraggedHandleStretchesAndTargetsTellHowFarTheyAreMissed) {
  Session session = measured(20);
  const std::string last = session.state().rig->skeleton().joints.back().name;
  perform(session, testing::movedBy(last, {0.5, 0, 0}));
  EXPECT_GT(measureSession(session).stretch, 0.01);
  const Vec3 position = poseGlobals(session.state().rig->skeleton(), session.state().pose).back().translation();
  perform(session, SetTarget{last, position + Vec3(0, 3, 0)});  // not pinned while inverse kinematics is off
  EXPECT_NEAR(measureSession(session).targetDistance.value(), 3, 1e-9);
}

TEST(Measures, AForkIsMeasuredWithoutTouchingTheDocument) {
  Session session = measured(20);
  const Bytes before = session.exportModel(ExportFormat::kGlb);
  Session fork = session.fork();
  perform(fork, SetHandles{9});
  EXPECT_EQ(measureSession(fork).joints, 9U);
  EXPECT_EQ(measuresToJson(measureSession(fork))["joints"], 9);
  EXPECT_EQ(session.exportModel(ExportFormat::kGlb), before);
  perform(fork, Undo{});
  EXPECT_FALSE(fork.canUndo());
  EXPECT_EQ(fork.exportModel(ExportFormat::kGlb), before);
}

}  // namespace
}  // namespace limber
