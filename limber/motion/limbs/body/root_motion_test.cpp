#include "limber/motion/limbs/body/root_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;

// The pelvis of `target` in rest pose, positioned for `source` moved by `displacement` from rest.
Vec3 retargetedPelvis(const Skeleton& source, const Skeleton& target, const Vec3& displacement,
                      const RetargetOptions& options) {
  const RetargetSetup setup(source, target, matchSkeletons(source, target), options);
  const RootPositioner positioner(setup);
  Pose from = restPose(source), to = restPose(target);
  from.locals[source.find("hips").value()].translation += displacement;
  BodyFrame fromFrame, toFrame;
  setup.sourceKinematics.globals(from, fromFrame);
  setup.targetKinematics.globals(to, toFrame);
  positioner.apply(from, fromFrame, to, toFrame);
  BodyFrame again;
  setup.targetKinematics.globals(to, again);
  for (Index j = 0; j < target.jointCount(); ++j) {
    EXPECT_LT((again.positions[j] - toFrame.positions[j]).norm(), 1e-12) << "the frame is up to date";
  }
  return pelvisOf(setup.map, MapSide::kTarget, toFrame.positions);
}

TEST(RootMotion, TheWayScalesWithTheHips) {
  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  const Vec3 displacement(0.4, -0.1, 1.2);
  for (const RootScale scale : {RootScale::kHipHeight, RootScale::kLegLength, RootScale::kNone}) {
    RetargetOptions options;
    options.rootScale = scale;
    const RetargetSetup setup(person, odd, matchSkeletons(person, odd), options);
    const Vec3 moved =
        retargetedPelvis(person, odd, displacement, options) - retargetedPelvis(person, odd, Vec3::Zero(), options);
    EXPECT_LT((setup.scale * displacement - moved).cwiseProduct(Vec3(1, 0, 1)).norm(), 1e-9);
    if (scale == RootScale::kHipHeight) continue;
    EXPECT_NEAR(moved.y(), setup.scale * displacement.y(), 1e-9);
  }
}

// High ankles: the legs are a smaller fraction of the hips' height.
TEST(RootMotion, HipsGoUpAndDownAsTheirLegsDo) {
  const Skeleton person = practiceHumanoid();
  Skeleton booted = person;
  for (const char* toes : {"leftToes", "rightToes"}) {
    booted.joints[booted.find(toes).value()].rest.translation.y() -= 0.3;
  }
  booted.joints[booted.find("hips").value()].rest.translation.y() += 0.3;
  const RetargetSetup setup(person, booted, matchSkeletons(person, booted), {});
  EXPECT_LT(setup.legFraction, 0.8);
  const Vec3 pelvis(0, setup.sourceGround + setup.sourceHipHeight, 0);
  const auto height = [&](double pathLength) {
    return setup.positionOf(pelvis + Vec3(0, pathLength, 0)).y() - setup.targetGround;
  };
  EXPECT_NEAR(height(0), setup.targetHipHeight, 1e-9);
  EXPECT_NEAR(height(-setup.sourceHipHeight), 0, 1e-9) << "who lies on the ground lies on it";
  // Its legs are as long as the source's: small and upward displacements stay as long.
  EXPECT_NEAR(height(0.1) - height(0), 0.1, 1e-9);
  EXPECT_NEAR(height(0) - height(-0.001), 0.001, 1e-5);
}

TEST(RootMotion, APelvisTurnsAloneAboutItsMiddle) {
  const Skeleton person = practiceHumanoid(), odd = oddlyBuilt();
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {});
  const RootPositioner positioner(setup);
  Pose pose = restPose(odd);
  BodyFrame before, after, again;
  setup.targetKinematics.globals(pose, before);
  after = before;
  const Quat turn = limber::testing::turn(Vec3(0.2, 1, 0.3), 30);
  positioner.turnPelvis(turn, pose, after);
  setup.targetKinematics.globals(pose, again);
  const Index hips = odd.find("hips").value(), left = odd.find("leftUpperLeg").value(),
              right = odd.find("rightUpperLeg").value();
  for (Index j = 0; j < odd.jointCount(); ++j) {
    const Quat expected = j == hips ? turn * before.rotations[j] : before.rotations[j];
    EXPECT_LT(again.rotations[j].angularDistance(expected), 1e-7) << odd.joints[j].name;
    EXPECT_LT((again.positions[j] - after.positions[j]).norm(), 1e-12) << "the frame is up to date";
  }
  EXPECT_LT(
      (pelvisOf(setup.map, MapSide::kTarget, again.positions) - pelvisOf(setup.map, MapSide::kTarget, before.positions))
          .norm(),
      1e-12);
  const Vec3 across = turn * (before.positions[left] - before.positions[right]);
  EXPECT_LT((again.positions[left] - again.positions[right] - across).norm(), 1e-12);
}

// A claw on a root on the ground: nothing in the motion moves it.
TEST(RootMotion, WhatNothingMatchesGoesAndTurnsWithTheFootThatItIsAt) {
  const Skeleton person = practiceHumanoid();
  Skeleton clawed = limber::testing::onTheGround(person, {});
  const Index foot = clawed.find("leftFoot").value();
  Joint claw;
  claw.name = "claw";
  claw.parent = 0;
  claw.rest.translation = restGlobals(clawed)[foot].translation() + Vec3(0, 0, 0.03);
  clawed.joints.push_back(claw);
  const Index at = clawed.jointCount() - 1;
  const PoseSequence motion = limber::testing::walk(person);
  const RetargetSetup setup(person, clawed, matchSkeletons(person, clawed), {}, &motion);
  for (const char* method : {"aligned", "limb-ik"}) {
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    const Affine rest = restGlobals(clawed)[foot].inverse() * restGlobals(clawed)[at];
    for (const Pose& pose : result.poses) {
      const std::vector<Affine> globals = poseGlobals(clawed, pose);
      EXPECT_LT((globals[foot].inverse() * globals[at].matrix() - rest.matrix()).norm(), 1e-6);
    }
  }
}

// Controls of inverse kinematics below roots of their own, one below another that follows the other hand, one on the
// toes of a foot that itself is on the ground's joint.
TEST(RootMotion, ControlsAreWhereTheJointsAreThatTheyRestOn) {
  const Skeleton person = practiceHumanoid();
  Skeleton rigged = limber::testing::onTheGround(person, {"leftFoot"});
  const auto at = [&](const std::string& joint) { return restGlobals(rigged)[rigged.find(joint).value()]; };
  const std::vector<std::array<std::string, 3>> controls = {{"ik_gun", "ground", "rightHand"},
                                                            {"ik_hand_l", "ik_gun", "leftHand"},
                                                            {"ik_toes", "ground", "leftToes"},
                                                            {"ik_foot_root", "ground", "ground"},
                                                            {"ik_foot_r", "ik_foot_root", "rightFoot"}};
  for (const auto& [name, parent, joint] : controls)
    limber::testing::addJoint(rigged, name, parent, at(joint).translation() - at(parent).translation());
  // Each with axes of its own, so that rotations show, too.
  rigged = limber::testing::withOtherAxes(rigged);
  const PoseSequence motion = limber::testing::walk(person);
  const RetargetSetup setup(person, rigged, matchSkeletons(person, rigged), {}, &motion);
  for (const char* method : {"copy", "aligned", "limb-ik", "spacetime"}) {
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    for (const auto& [name, parent, joint] : controls) {
      const Index control = rigged.find(name).value(), carrier = rigged.find(joint).value();
      const Affine rest = at(joint).inverse() * at(name);
      double most = 0;
      for (const Pose& pose : result.poses) {
        const std::vector<Affine> globals = poseGlobals(rigged, pose);
        most = std::max(most, (globals[carrier].inverse() * globals[control].matrix() - rest.matrix()).norm());
      }
      EXPECT_LT(most, 1e-6) << method << ", " << name;
    }
  }
}

// A body a metre long with a leg below each end; lying down, the legs go on along the body.
Skeleton animal(double leg, bool lies) {
  const Vec3 displacement = lies ? Vec3(0, 0, leg) : Vec3(0, -leg, 0);
  Skeleton skeleton;
  const auto add = [&](const char* name, std::optional<Index> parent, const Vec3& offset) {
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.rest.translation = offset;
    skeleton.joints.push_back(joint);
  };
  add("body", std::nullopt, lies ? Vec3(Vec3::Zero()) : Vec3(0, leg, 0));
  add("chest", Index{0}, Vec3(0, 0, 1));
  add("hindPaw", Index{0}, lies ? Vec3(-displacement) : displacement);
  add("forePaw", Index{1}, displacement);
  return skeleton;
}

TEST(RootMotion, AnimalsGoAsFarAsTheyStandHigh) {
  SkeletonMap map;
  for (Index j = 0; j < 4; ++j)
    map.matches.push_back({{PartKind::kOther, Side::kCenter, 0, Segment::kWhole, j}, {j}, {j}});
  const auto scale = [&](const Skeleton& from, const Skeleton& to) { return RetargetSetup(from, to, map, {}).scale; };
  EXPECT_NEAR(scale(animal(0.5, false), animal(1, false)), 2, 1e-12);
  EXPECT_NEAR(scale(animal(0.5, true), animal(1, true)), 3.0 / 2, 1e-12);
  const double mixed = scale(animal(0.5, false), animal(1, true));  // by what both have: their size
  EXPECT_NEAR(mixed, 3 / std::hypot(1, 0.5), 1e-12);
}

// Bodies of one form, whatever their joints' own axes: a joint that moves on its parent has the same displacement in
// space.
TEST(RootMotion, WaysOfAnimalsJointsAreThoseThroughSpace) {
  const Skeleton one = limber::testing::quadruped(0.5), other = limber::testing::withOtherAxes(one);
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
  const Index chest = one.find("b1").value();
  Pose pose = restPose(one);
  pose.locals[0].rotation = limber::testing::turn(Vec3::UnitX(), 20);
  pose.locals[chest].translation += Vec3(0.1, 0.2, 0.3);
  const PoseSequence result = retargetFrames(findRetargetMethod("aligned"), setup, {{pose}, 1.0 / 60});
  const std::vector<Affine> expected = poseGlobals(one, pose), globals = poseGlobals(other, result.poses.front());
  for (Index j = 0; j < one.jointCount(); ++j) {
    EXPECT_LT((globals[j].translation() - expected[j].translation()).norm(), 1e-6) << one.joints[j].name;
  }
}

// Of bodies that turn about a joint that lies elsewhere.
TEST(RootMotion, HipsOfAnimalsGoAsTheSources) {
  const Skeleton one = limber::testing::quadruped(0.5), other = limber::testing::quadrupedOnOneJoint();
  for (const auto& [source, target] : {std::pair(one, other), std::pair(other, one)}) {
    const RetargetSetup setup(source, target, limber::testing::matchByForm(source, target), {});
    const RootPositioner positioner(setup);
    Pose from = restPose(source), to = restPose(target);
    from.locals[0].rotation = to.locals[0].rotation = limber::testing::turn(-Vec3::UnitX(), 40);
    BodyFrame fromFrame, toFrame;
    setup.sourceKinematics.globals(from, fromFrame);
    setup.targetKinematics.globals(to, toFrame);
    positioner.apply(from, fromFrame, to, toFrame);
    EXPECT_LT(
        (toFrame.positions[target.find("b0LeftOne").value()] - fromFrame.positions[source.find("b0LeftOne").value()])
            .norm(),
        0.05);
  }
}

TEST(RootMotion, ThePelvisMovesByWhatIsAsked) {
  const Skeleton person = practiceHumanoid(), odd = limber::testing::withOtherAxes(oddlyBuilt());
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {});
  const RootPositioner positioner(setup);
  Pose pose = restPose(odd);
  BodyFrame frame;
  setup.targetKinematics.globals(pose, frame);
  const BodyFrame before = frame;
  const Vec3 shift(0.1, -0.2, 0.3);
  positioner.movePelvis(shift, pose, frame);
  const Index hips = setup.map.find(body_part::kPelvis)->target.front(),
              hand = setup.map.find(body_part::arm(Side::kLeft, Segment::kEnd))->target.front();
  EXPECT_LT((frame.positions[hips] - before.positions[hips] - shift).norm(), 1e-12);
  EXPECT_LT((frame.positions[hand] - before.positions[hand] - shift).norm(), 1e-12);
}

}  // namespace
}  // namespace limber
