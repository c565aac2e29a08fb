#include "limber/session/drag/standing_feet.h"

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/session/session.h"

namespace limber {
namespace {

const Vec3 kLook(0, 0, -1);

Session opened(const char* sample, bool limbsFollow = true) {
  Session session;
  Progress progress;
  session.run(OpenSample{sample, limbsFollow}, progress);
  return session;
}

Affine globalOf(const Session& session, Index joint) {
  return poseGlobals(session.state().rig->skeleton(), session.state().pose)[joint];
}

const std::string& nameOfJoint(const Session& session, Index joint) {
  return session.state().rig->skeleton().joints[joint].name;
}

BeginDrag take(const Session& session, Index joint, DragMode mode = DragMode::kMove) {
  BeginDrag begin;
  begin.joint = nameOfJoint(session, joint);
  begin.mode = mode;
  return begin;
}

// By the joint's middle, seen from the front.
void drag(Session& session, BeginDrag begin, const Vec3& offset) {
  Progress progress;
  const Vec3 from = globalOf(session, *session.state().rig->skeleton().find(begin.joint)).translation();
  const Vec3 eye = from - 5 * kLook;
  begin.ray = {eye, kLook};
  begin.view = kLook;
  session.run(begin, progress);
  session.run(UpdateDrag{{eye, from + offset - eye}, kLook}, progress);
  session.run(EndDrag{}, progress);
}

Index part(const Session& session, PartKind kind, Side side) {
  const Part* found = session.state().rig->anatomy().find(kind, side);
  return found->end.value_or(found->joints.back());
}

TEST(StandingFeet, LimbsFollowOnBodiesAndOnHandlesThatMakeChains) {
  for (const char* body : {"biped", "quadruped", "winged", "robot"}) EXPECT_TRUE(opened(body).state().ik) << body;
  Session stool = opened("stool");
  EXPECT_TRUE(stool.state().ik);
  Progress progress;
  stool.run(SetHandles{3}, progress);
  EXPECT_FALSE(hasLimbs(*stool.state().rig));
  EXPECT_FALSE(opened("biped", false).state().ik);
}

// Handles of a hand are small and in a row, as a finger's are.
TEST(StandingFeet, ArmsOfHandlesEndInHands) {
  Session session = opened("biped");
  Progress progress;
  for (const Index handles : {20u, 28u, 36u}) {
    session.run(SetHandles{handles}, progress);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const Part* arm = session.state().rig->anatomy().find(PartKind::kArm, side);
      ASSERT_TRUE(arm) << handles;
      EXPECT_TRUE(arm->end) << handles;
    }
  }
}

TEST(StandingFeet, AreHeldOnceForEachLegThatStands) {
  EXPECT_EQ(opened("biped").state().targets.size(), 2u);
  EXPECT_EQ(opened("quadruped").state().targets.size(), 4u);
}

TEST(StandingFeet, StayWhereTheyAreWithTheirSolesWhileTheHipsGoDown) {
  Session session = opened("biped");
  const std::vector<PinnedTarget> feet = session.state().targets;
  const Index root = 0;
  drag(session, take(session, root), {0.02, -0.12, 0});
  for (const PinnedTarget& foot : feet) {
    const Affine now = globalOf(session, foot.joint);
    EXPECT_LT((now.translation() - foot.position).norm(), 2e-3);
    EXPECT_LT(angleBetween(decompose(now).rotation, *foot.rotation), 1e-6);
  }
}

TEST(StandingFeet, AFootThatIsLiftedStaysInTheAir) {
  Session session = opened("biped");
  const Index foot = part(session, PartKind::kLeg, Side::kLeft);
  const Vec3 before = globalOf(session, foot).translation();
  drag(session, take(session, foot), {0.05, 0.2, 0});
  EXPECT_LT((globalOf(session, foot).translation() - before - Vec3(0.05, 0.2, 0)).norm(), 5e-3);
  const Index hand = part(session, PartKind::kArm, Side::kRight);
  const Vec3 lifted = globalOf(session, foot).translation();
  drag(session, take(session, hand), {0, 0.2, 0});
  EXPECT_LT((globalOf(session, foot).translation() - lifted).norm(), 2e-3);
}

TEST(StandingFeet, AFootRollsOverItsToesWhereItsKneeIsDragged) {
  Session session = opened("biped");
  const Part& leg = *session.state().rig->anatomy().find(PartKind::kLeg, Side::kLeft);
  ASSERT_TRUE(leg.toes && leg.middle);
  const Index toes = *leg.toes, knee = *leg.middle;
  const Vec3 toesBefore = globalOf(session, toes).translation(), kneeBefore = globalOf(session, knee).translation();
  drag(session, take(session, knee), {0.08, 0.03, 0});
  EXPECT_GT((globalOf(session, knee).translation() - kneeBefore).norm(), 0.04);
  EXPECT_LT((globalOf(session, toes).translation() - toesBefore).norm(), 0.02);
}

TEST(StandingFeet, AreHeldAnewWithAnotherRigAndAfterAReset) {
  Session session = opened("biped");
  Progress progress;
  const Index foot = part(session, PartKind::kLeg, Side::kLeft);
  drag(session, take(session, foot), {0, 0.3, 0});
  session.run(ResetPose{}, progress);
  const Index again = part(session, PartKind::kLeg, Side::kLeft);
  EXPECT_LT((globalOf(session, again).translation() - restGlobals(session.state().rig->skeleton())[again].translation())
                .norm(),
            1e-6);
  EXPECT_EQ(session.state().targets.size(), 2u);
  session.run(SetHandles{30}, progress);
  EXPECT_EQ(session.state().targets.size(), 2u);
}

TEST(StandingFeet, BothSidesMoveAsEachOthersMirrorImage) {
  Session session = opened("biped");
  const Index left = part(session, PartKind::kArm, Side::kLeft), right = part(session, PartKind::kArm, Side::kRight);
  BeginDrag begin = take(session, left);
  begin.mirrored = true;
  drag(session, begin, {-0.1, 0.25, 0});
  const Vec3 one = globalOf(session, left).translation(), other = globalOf(session, right).translation();
  EXPECT_LT((Vec3(-one.x(), one.y(), one.z()) - other).norm(), 1e-3);
  begin = take(session, left, DragMode::kTurn);
  begin.mirrored = true;
  drag(session, begin, {0.1, -0.3, 0});
  const Vec3 turned = globalOf(session, left).translation(), image = globalOf(session, right).translation();
  EXPECT_GT((turned - one).norm(), 0.05);
  EXPECT_LT((Vec3(-turned.x(), turned.y(), turned.z()) - image).norm(), 2e-3);
}

TEST(StandingFeet, SeveralJointsMoveTogether) {
  Session session = opened("stool", false);
  const Vec3 offset(0.03, 0.05, 0);
  const Vec3 a = globalOf(session, 5).translation(), b = globalOf(session, 9).translation();
  BeginDrag begin = take(session, 5);
  begin.with = {nameOfJoint(session, 9)};
  drag(session, begin, offset);
  EXPECT_LT((globalOf(session, 5).translation() - a - offset).norm(), 1e-9);
  EXPECT_LT((globalOf(session, 9).translation() - b - offset).norm(), 1e-9);
}

}  // namespace
}  // namespace limber
