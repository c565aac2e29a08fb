// Joints put exactly where a number says, one or several at once.
#include <limits>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/session/edit/clip_curves.h"
#include "limber/session/session.h"
#include "limber/session/session_state.h"

namespace limber {
namespace {

class PlaceJointTest : public ::testing::Test {
 protected:
  PlaceJointTest() { run(OpenSample{"biped", true}); }

  void run(const Command& command) {
    Progress progress;
    session.run(command, progress);
  }
  const Skeleton& skeleton() const { return session.state().rig->skeleton(); }
  Affine globalOf(Index joint) const { return poseGlobals(skeleton(), session.state().pose)[joint]; }
  Vec3 positionOf(Index joint) const { return globalOf(joint).translation(); }
  Vec3 turnOf(Index joint) const {
    return pointFromRest(session.state().pose.locals[joint], skeleton().joints[joint].rest).turn;
  }
  Index end(PartKind kind, Side side) const {
    const Part* part = session.state().rig->anatomy().find(kind, side);
    return part->end.value_or(part->joints.back());
  }
  const std::string& name(Index joint) const { return skeleton().joints[joint].name; }
  std::size_t steps() {
    std::size_t count = 0;
    for (; session.canUndo(); ++count) run(Undo{});
    return count;
  }

  Session session;
};

TEST_F(PlaceJointTest, AHandTakesItsArmAlongAndTheFeetStay) {
  const Index hand = end(PartKind::kArm, Side::kLeft), above = *skeleton().joints[hand].parent;
  const std::vector<PinnedTarget> feet = session.state().targets;
  const Vec3 wanted = positionOf(hand) + Vec3(-0.08, 0.1, 0.05);
  const double bone = (positionOf(hand) - positionOf(above)).norm();
  run(PlaceJoint{name(hand), wanted});
  EXPECT_LT((positionOf(hand) - wanted).norm(), 1e-3);
  EXPECT_NEAR((positionOf(hand) - positionOf(above)).norm(), bone, 1e-9);
  for (const PinnedTarget& foot : feet) EXPECT_LT((positionOf(foot.joint) - foot.position).norm(), 1e-3);
  EXPECT_EQ(session.undoName(), "place_joint");
  EXPECT_EQ(steps(), 1u);
}

TEST_F(PlaceJointTest, DoesWhatADragThereDoes) {
  const Index foot = end(PartKind::kLeg, Side::kLeft), hand = end(PartKind::kArm, Side::kLeft);
  const Vec3 from = positionOf(foot), offset(0.03, 0.08, 0);
  run(PlaceJoint{name(foot), from + offset, {name(hand)}, true});
  const Pose placed = session.state().pose;
  const std::vector<PinnedTarget> pinned = session.state().targets;
  run(Undo{});
  run(BeginDrag{
      name(foot), DragMode::kMove, {from + Vec3::UnitZ(), -Vec3::UnitZ()}, -Vec3::UnitZ(), {name(hand)}, true});
  run(UpdateDrag{{from + offset + Vec3::UnitZ(), -Vec3::UnitZ()}, -Vec3::UnitZ()});
  run(EndDrag{});
  for (Index j = 0; j < placed.locals.size(); ++j) {
    EXPECT_LT(angleBetween(placed.locals[j].rotation, session.state().pose.locals[j].rotation), 1e-6);
  }
  ASSERT_EQ(pinned.size(), session.state().targets.size());
  for (std::size_t t = 0; t < pinned.size(); ++t) {
    EXPECT_LT((pinned[t].position - session.state().targets[t].position).norm(), 1e-6);
  }
}

TEST_F(PlaceJointTest, AJointTurnsToWhatIsSaidAndSeveralAtOnce) {
  const Index hand = end(PartKind::kArm, Side::kLeft), elbow = *skeleton().joints[hand].parent;
  const Vec3 turn(10, -35, 62.5);
  run(SetTurn{name(elbow), {5, 5, 5}});
  run(SetTurn{name(elbow), turn, {name(hand)}});
  EXPECT_LT((turnOf(elbow) - turn).norm(), 1e-6);
  EXPECT_LT((turnOf(hand) - turn).norm(), 1e-6);
  EXPECT_EQ(steps(), 2u);
  EXPECT_LT(turnOf(elbow).norm(), 1e-6);
}

TEST_F(PlaceJointTest, TheOtherSideTurnsInTheMirror) {
  const Index left = end(PartKind::kArm, Side::kLeft), right = end(PartKind::kArm, Side::kRight);
  run(SetTurn{name(*skeleton().joints[left].parent), {20, 10, -40}, {}, true});
  const Vec3 image = positionOf(left).cwiseProduct(Vec3(-1, 1, 1));
  EXPECT_LT((positionOf(right) - image).norm(), 2e-3);
}

TEST_F(PlaceJointTest, AJointIsScaledFromItsRestPoseAndWhatHangsOnItComesAlong) {
  const Index hand = end(PartKind::kArm, Side::kLeft), elbow = *skeleton().joints[hand].parent;
  const Index other = *skeleton().joints[end(PartKind::kArm, Side::kRight)].parent;
  const Vec3 from = positionOf(elbow);
  const double forearm = (positionOf(hand) - from).norm();
  run(SetScale{name(elbow), 3});
  run(SetScale{name(elbow), 1.5, {}, true});
  EXPECT_LT((positionOf(elbow) - from).norm(), 1e-12);
  EXPECT_NEAR((positionOf(hand) - from).norm(), 1.5 * forearm, 1e-9);
  EXPECT_NEAR(session.state().pose.locals[other].scale.x(), 1.5, 1e-12);
  run(SetScale{name(elbow), 2, {}, false, true});
  EXPECT_NEAR((positionOf(hand) - from).norm(), 3 * forearm, 1e-9);
  run(SetScale{name(elbow), 1, {}, true});
  EXPECT_NEAR((positionOf(hand) - from).norm(), forearm, 1e-9);
  EXPECT_THROW(run(SetScale{name(elbow), 0}), Error);
  EXPECT_THROW(run(SetScale{name(elbow), -1}), Error);
  EXPECT_EQ(steps(), 4u);
}

TEST_F(PlaceJointTest, ADragThatScalesDoesWhatANumberDoesInOneStep) {
  const std::string hips = name(0), hand = name(end(PartKind::kArm, Side::kLeft));
  for (const std::string& joint : {hips, hand}) {
    run(SetScale{joint, 1.2});
    run(SetScale{joint, 1.5, {}, true, true});
    const Pose scaled = session.state().pose;
    const std::vector<PinnedTarget> feet = session.state().targets;
    run(Undo{});
    run(BeginDrag{joint, DragMode::kScale, {}, -Vec3::UnitZ(), {}, true});
    run(ScaleDrag{0.7});
    run(ScaleDrag{1.5});
    run(EndDrag{});
    EXPECT_TRUE(samePose(session.state().pose, scaled));
    ASSERT_EQ(session.state().targets.size(), feet.size());
    for (std::size_t t = 0; t < feet.size(); ++t) EXPECT_EQ(session.state().targets[t].position, feet[t].position);
  }
  EXPECT_EQ(steps(), 4u);
}

TEST_F(PlaceJointTest, LimitsHold) {
  const Index hand = end(PartKind::kArm, Side::kLeft);
  run(SetLimits{R"({"limber_limits": 1, "joints": {")" + name(hand) + R"(": {"type": "fixed"}}})"});
  run(SetTurn{name(hand), {0, 0, 50}});
  EXPECT_LT(turnOf(hand).norm(), 1e-6);
}

TEST_F(PlaceJointTest, WhatIsNoNumberIsRefusedAndChangesNothing) {
  const std::string joint = name(end(PartKind::kArm, Side::kLeft));
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(run(PlaceJoint{joint, {nothing, 0, 0}}), Error);
  EXPECT_THROW(run(SetTurn{joint, {0, nothing, 0}}), Error);
  EXPECT_THROW(run(SetTurn{"nobody", {0, 10, 0}}), Error);
  EXPECT_THROW(run(PlaceJoint{joint, {0, 1, 0}, {"nobody"}}), Error);
  EXPECT_FALSE(session.canUndo());
}

TEST_F(PlaceJointTest, SeveralAreResetHeldAndLockedAsOneStep) {
  const Index left = end(PartKind::kArm, Side::kLeft), right = end(PartKind::kArm, Side::kRight);
  run(SetTurn{name(left), {0, 30, 0}, {name(right)}});
  run(ResetJoint{name(left), {name(right)}});
  EXPECT_LT(turnOf(left).norm() + turnOf(right).norm(), 1e-6);
  run(SetTarget{name(left), positionOf(left), {name(right)}});
  EXPECT_EQ(session.state().targets.size(), 4u);
  run(ClearTarget{name(left), {name(right)}});
  EXPECT_EQ(session.state().targets.size(), 2u);
  run(LockWeights{name(left), true, {name(right)}});
  EXPECT_EQ(session.state().locked.size(), 2u);
  EXPECT_EQ(steps(), 5u);
}

TEST_F(PlaceJointTest, DragsThatGoOnAreOneStep) {
  const std::string joint = name(end(PartKind::kArm, Side::kLeft));
  const Pose before = session.state().pose;
  const auto nudge = [&](bool goesOn) {
    run(BeginDrag{joint, DragMode::kTurn, {}});
    run(TurnDrag{Vec3::UnitZ(), 5});
    run(EndDrag{goesOn});
  };
  nudge(false);
  nudge(true);
  nudge(true);
  const Pose after = session.state().pose;
  run(Undo{});
  EXPECT_TRUE(samePose(session.state().pose, before));
  EXPECT_FALSE(session.canUndo());
  nudge(true);  // what was undone is not gone on with
  run(SetTurn{joint, {0, 20, 0}});
  nudge(true);
  EXPECT_EQ(steps(), 3u);
  EXPECT_FALSE(samePose(after, before));
}

TEST_F(PlaceJointTest, TheRecordReplayedGivesTheSamePose) {
  const std::string hand = name(end(PartKind::kArm, Side::kLeft));
  run(PlaceJoint{hand, positionOf(end(PartKind::kArm, Side::kLeft)) + Vec3(0, 0.1, 0.1), {}, true});
  run(SetTurn{hand, {10, 20, 30}, {name(0)}});
  Session again;
  Progress progress;
  for (const Command& command : commandsFromJson(commandsToJson(session.record()))) again.run(command, progress);
  EXPECT_TRUE(samePose(again.state().pose, session.state().pose));
}

}  // namespace
}  // namespace limber
