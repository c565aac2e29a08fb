#include "limber/session/drag/snap.h"

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/core/text/numbers.h"
#include "limber/session/session.h"

namespace limber {
namespace {

TEST(Snap, StepsAreRoundNumbersNearTheLength) {
  EXPECT_DOUBLE_EQ(roundStep(0.0175), 0.02);
  EXPECT_DOUBLE_EQ(roundStep(0.06), 0.05);
  EXPECT_DOUBLE_EQ(roundStep(0.96), 1);
  EXPECT_DOUBLE_EQ(roundStep(3.3), 5);
  EXPECT_DOUBLE_EQ(roundStep(100), 100);
  EXPECT_DOUBLE_EQ(roundStep(0), 1);
  for (double length = 1e-6; length < 1e6; length *= 1.07) {
    EXPECT_LE(std::max(roundStep(length) / length, length / roundStep(length)), std::sqrt(2.5) + 1e-12);
  }
}

TEST(Snap, PlacesGoToTheGridAndFeetToTheFloor) {
  DragSnap snap;
  snap.step = 0.05;
  EXPECT_LT((snapPosition(snap, {0.26, -0.024, 1.03}) - Vec3(0.25, 0, 1.05)).norm(), 1e-12);
  snap.ground = 0.07;
  EXPECT_LT((snapPosition(snap, {0.26, 0.11, 1.03}) - Vec3(0.25, 0.07, 1.05)).norm(), 1e-12);
  EXPECT_LT((snapPosition(snap, {0.26, 0.03, 1.03}) - Vec3(0.25, 0.07, 1.05)).norm(), 1e-12);
  EXPECT_LT((snapPosition(snap, {0.26, 0.21, 1.03}) - Vec3(0.25, 0.2, 1.05)).norm(), 1e-12);
}

TEST(Snap, TurnsKeepTheirAxis) {
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  for (const auto& [given, expected] :
       {std::pair(22.0, 15.0), {23.0, 30.0}, {-50.0, -45.0}, {3.0, 0.0}, {179.0, 180.0}}) {
    const Quat turn = snapTurn({}, Quat(Eigen::AngleAxisd(given * kDegree, axis)));
    EXPECT_LT(angleBetween(turn, Quat(Eigen::AngleAxisd(expected * kDegree, axis))), 1e-9) << given;
  }
}

TEST(Snap, ScalesAreTenthsAbove0) {
  EXPECT_EQ(snapScale(1.27), 1.3);
  EXPECT_EQ(snapScale(0.98), 1);
  EXPECT_EQ(snapScale(0.02), 0.1);
}

TEST(Snap, AFootOfABodyKnowsWhereTheFloorIs) {
  Session session;
  Progress progress;
  session.run(OpenSample{"biped", true}, progress);
  const SessionState& state = session.state();
  ASSERT_FALSE(state.targets.empty());
  const PinnedTarget& foot = state.targets.front();
  const DragSnap snap = snapOf(*state.rig, foot.joint);
  EXPECT_DOUBLE_EQ(snap.step, 0.02);
  ASSERT_TRUE(snap.ground);
  EXPECT_NEAR(*snap.ground, foot.position.y(), 0.01);
  EXPECT_FALSE(snapOf(*state.rig, state.rig->anatomy().find(PartKind::kHead, Side::kCenter)->joints.front()).ground);
}

}  // namespace
}  // namespace limber
