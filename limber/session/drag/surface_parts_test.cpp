#include "limber/session/drag/surface_parts.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/parts/model_parts.h"

namespace limber {
namespace {

using ::testing::IsSupersetOf;

void tellSession(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

Session bipedWithNames() {
  Session session;
  tellSession(session, OpenSample{"biped"});
  tellSession(session, ChooseMethods{"template", "bone-heat"});
  return session;
}

TEST(SurfaceParts, AreThoseOfTheSavedModel) {
  const Session session = bipedWithNames();
  const SessionState& state = session.state();
  const SurfaceParts parts = surfaceParts(state);
  Progress progress;
  const Asset saved = documentOf(*state.rig);
  const SurfaceParts expected = modelParts(saved, {}, progress);
  EXPECT_EQ(parts.names, expected.names);
  EXPECT_EQ(parts.partOf, expected.partOf);
  EXPECT_EQ(parts.partOf.size(), state.rig->geometry().triangles.size());
  EXPECT_THAT(parts.names, IsSupersetOf({"leftArm", "rightArm", "leftLeg", "rightLeg"}));
}

// Where one joint holds all, there is one part.
TEST(SurfaceParts, FollowPaintedWeights) {
  Session session = bipedWithNames();
  const SurfaceParts before = surfaceParts(session.state());
  const RiggedModel& rig = *session.state().rig;
  SkinWeights weights = rig.weights;
  std::fill(weights.joints.begin(), weights.joints.end(), rig.skeleton().find("leftUpperArm").value());
  SessionState painted = session.state();
  painted.rig = withWeights(rig, std::move(weights));
  const SurfaceParts after = surfaceParts(painted);
  EXPECT_GT(before.partCount(), 4u);
  EXPECT_EQ(after.partCount(), 1u);
}

TEST(SurfaceParts, HandlesWithoutNamesHavePartsToo) {
  Session session;
  tellSession(session, OpenSample{"biped"});
  const SurfaceParts parts = surfaceParts(session.state());
  EXPECT_GT(parts.partCount(), 1u);
  for (const Index part : parts.partOf) EXPECT_LT(part, parts.partCount());
}

}  // namespace
}  // namespace limber
