#include "limber/character/matching/twin_match.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::inRestPose;
using limber::testing::NameHabit;
using limber::testing::nameless;
using limber::testing::personWith;
using limber::testing::scaled;
using limber::testing::turn;
using limber::testing::turnedAsAWhole;
using limber::testing::withOtherAxes;

Skeleton original() {
  return personWith(NameHabit::kMixamo).skeleton;  // 25 joints
}

// The last of siblings first.
Skeleton inAnotherOrder(const Skeleton& skeleton) {
  Skeleton other;
  std::vector<Index> open;
  const auto push = [&](std::optional<Index> parent) {
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      if (skeleton.joints[j].parent == parent) open.push_back(j);
    }
  };
  push(std::nullopt);
  while (!open.empty()) {
    const Index next = open.back();
    open.pop_back();
    Joint joint = skeleton.joints[next];
    if (joint.parent) joint.parent = other.find(skeleton.joints[*joint.parent].name);
    other.joints.push_back(joint);
    push(next);
  }
  return other;
}

// What `change` makes of the person has the joint of the same name as each joint's twin; the matcher sees no names.
template <typename Change>
void expectTwins(const Change& change, const Quat& turned = Quat::Identity(), double size = 1) {
  const Skeleton source = original(), named = change(source), target = nameless(named);
  const std::optional<Twins> twins = matchTwins(source, target);
  ASSERT_TRUE(twins);
  ASSERT_EQ(twins->sourceOf.size(), target.joints.size());
  for (Index j = 0; j < target.jointCount(); ++j) {
    EXPECT_EQ(source.joints[twins->sourceOf[j]].name, named.joints[j].name);
  }
  EXPECT_LT(twins->turn.angularDistance(turned), 1e-6);
  EXPECT_NEAR(twins->scale, size, 1e-9);
}

TEST(TwinMatch, TheSameUnderOtherNames) {
  expectTwins([](const Skeleton& person) { return person; });
  const Skeleton biped = personWith(NameHabit::kBiped).skeleton;
  const std::optional<Twins> twins = matchTwins(original(), biped);
  ASSERT_TRUE(twins);
  for (Index j = 0; j < biped.jointCount(); ++j) EXPECT_EQ(twins->sourceOf[j], j);
}

TEST(TwinMatch, InAnotherOrder) {
  expectTwins([](const Skeleton& person) { return inAnotherOrder(person); });
}

TEST(TwinMatch, TurnedByQuarters) {
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
    for (const double degrees : {90.0, 180.0, 270.0}) {
      SCOPED_TRACE(axis.transpose());
      const Quat quarter = turn(axis, degrees);
      expectTwins([&](const Skeleton& person) { return turnedAsAWhole(inAnotherOrder(person), quarter); }, quarter);
    }
  }
}

TEST(TwinMatch, TurnedAnyhow) {
  for (int i = 1; i <= 8; ++i) {
    SCOPED_TRACE(i);
    const Quat any = turn(Vec3(std::sin(i), std::cos(1.7 * i), std::sin(2.9 * i + 1)), 43.0 * i);
    expectTwins([&](const Skeleton& person) { return turnedAsAWhole(inAnotherOrder(person), any); }, any);
  }
}

TEST(TwinMatch, OfAnotherSizeAndWithOtherAxes) {
  expectTwins([](const Skeleton& person) { return scaled(person, 100); }, Quat::Identity(), 100);
  expectTwins([](const Skeleton& person) { return withOtherAxes(person); });
  const Quat any = turn(Vec3(1, 2, -1), 77);
  expectTwins(
      [&](const Skeleton& person) { return scaled(turnedAsAWhole(withOtherAxes(inAnotherOrder(person)), any), 0.01); },
      any, 0.01);
}

TEST(TwinMatch, AnotherProportionIsNone) {
  for (const char* joint : {"mixamorig:LeftLeg", "mixamorig:Spine1", "mixamorig:Head"}) {
    Skeleton other = original();
    other.joints[other.find(joint).value()].rest.translation *= 1.15;
    EXPECT_FALSE(matchTwins(original(), other)) << joint;
  }
}

TEST(TwinMatch, AnotherTreeIsNone) {
  Skeleton more = original(), moved = original();
  limber::testing::addJoint(more, "tail", "mixamorig:Hips", Vec3(0, 0, -0.2));
  EXPECT_FALSE(matchTwins(original(), more));
  EXPECT_FALSE(matchTwins(more, original()));
  moved.joints.back().parent = moved.find("mixamorig:Hips");
  EXPECT_FALSE(matchTwins(original(), moved));
  EXPECT_FALSE(matchTwins(original(), limber::testing::snake().skeleton));
}

TEST(TwinMatch, NothingAndJointsInOnePlaceAreNone) {
  EXPECT_FALSE(matchTwins(Skeleton(), Skeleton()));
  Skeleton folded = original();
  for (Joint& joint : folded.joints) joint.rest.translation = Vec3::Zero();
  EXPECT_FALSE(matchTwins(folded, original()));
  EXPECT_FALSE(matchTwins(original(), folded));
}

// Every joint is where the twin's is, but for the root's position.
void expectParallel(const Skeleton& source, const Pose& sourcePose, const Skeleton& target, const Twins& twins,
                    const Pose& pose) {
  const std::vector<Affine> from = poseGlobals(source, sourcePose), to = poseGlobals(target, pose);
  const double size = twins.scale * (restPositions(source)[0]).norm();
  for (Index j = 0; j < target.jointCount(); ++j) {
    const Vec3 wanted =
        twins.scale * (twins.turn * (from[twins.sourceOf[j]].translation() - from[twins.sourceOf[0]].translation()));
    EXPECT_LT((to[j].translation() - to[0].translation() - wanted).norm(), 1e-9 * size) << target.joints[j].name;
  }
}

const std::map<std::string, Quat> kBentLimbs = {{"mixamorig:LeftUpLeg", turn(Vec3(1, 0, 0.4), 15)},
                                                {"mixamorig:RightArm", turn(Vec3(0.2, 1, 0.7), -15)},
                                                {"mixamorig:LeftForeArm", turn(Vec3(0.1, 0.9, 0), 15)},
                                                {"mixamorig:Neck", turn(Vec3::UnitX(), 15)}};

// Whose joints are in the order of the original's.
void expectTurnedBack(const Skeleton& target) {
  const Skeleton source = original();
  const std::optional<Twins> twins = matchTwins(source, nameless(target));
  ASSERT_TRUE(twins);
  for (Index j = 0; j < target.jointCount(); ++j) EXPECT_EQ(twins->sourceOf[j], j) << target.joints[j].name;
  const Pose rest = restPose(source);
  expectParallel(source, rest, target, *twins, poseAsTwin(source, rest, target, *twins));
}

TEST(TwinMatch, LimbsThatRestOtherwiseAreTurnedBackExactly) {
  for (const auto& limb : kBentLimbs) {
    SCOPED_TRACE(limb.first);
    const Skeleton bent = inRestPose(original(), {limb});
    expectTurnedBack(bent);
    expectTurnedBack(scaled(withOtherAxes(bent), 3));
    expectTurnedBack(turnedAsAWhole(bent, turn(Vec3::UnitX(), 90)));
  }
  expectTurnedBack(withOtherAxes(inRestPose(original(), kBentLimbs)));
}

// Equal fingers side by side, in the plane in which the arm is turned: where they lie, another would be nearer.
TEST(TwinMatch, FingersOfALimbThatRestsOtherwiseKeepTheirPlaces) {
  Skeleton source = original();
  const Index hand = source.find("mixamorig:LeftHand").value();
  const std::vector<Vec3> positions = restPositions(source);
  const Vec3 along = (positions[hand] - positions[*source.joints[hand].parent]).normalized();
  const Vec3 across = along.cross(Vec3::UnitZ()).normalized();
  const Quat toHand = Quat(restGlobals(source)[hand].rotation()).conjugate();
  for (int i = 0; i < 4; ++i) {
    Joint finger;
    finger.name = "finger" + std::to_string(i);
    finger.parent = hand;
    finger.rest.translation = toHand * Vec3(0.1 * along + 0.02 * (i - 1.5) * across);
    source.joints.push_back(finger);
  }
  const Skeleton target = nameless(inRestPose(source, {{"mixamorig:LeftArm", turn(Vec3::UnitZ(), 40)}}));
  const std::optional<Twins> twins = matchTwins(source, target);
  ASSERT_TRUE(twins);
  for (Index j = 0; j < target.jointCount(); ++j) EXPECT_EQ(twins->sourceOf[j], j) << source.joints[j].name;
}

// Joints on one line do not say how it is twisted: the shortest rotation.
TEST(TwinMatch, AStraightLimbIsNotTwisted) {
  Skeleton source;
  for (Index i = 0; i < 5; ++i) {
    Joint joint;
    joint.name = "joint" + std::to_string(i);
    if (i > 0) joint.parent = i < 4 ? i - 1 : 0;
    joint.rest.translation = i < 4 ? Vec3(0.3, 0.2, -0.4) : Vec3(0, 0, 0.3);
    source.joints.push_back(joint);
  }
  Skeleton target = source;
  const Vec3 across = source.joints[1].rest.translation.cross(Vec3(1, 2, 3)).normalized();
  target.joints[1].rest.rotation = turn(across, 30);
  const Twins twins{{0, 1, 2, 3, 4}, Quat::Identity(), 1};
  const Pose pose = poseAsTwin(source, restPose(source), target, twins);
  EXPECT_LT(pose.locals[1].rotation.angularDistance(Quat::Identity()), 1e-7);
}

// More bones than stay as they are.
TEST(TwinMatch, AllLimbsAtOnceAreTurnedBackExactly) {
  std::vector<std::pair<const char*, Quat>> limbs;
  for (const auto& [name, degrees] : {std::pair{"mixamorig:LeftArm", 40},
                                      {"mixamorig:RightArm", -40},
                                      {"mixamorig:LeftUpLeg", 7},
                                      {"mixamorig:RightUpLeg", -7}}) {
    limbs.push_back({name, turn(Vec3::UnitZ(), degrees)});
  }
  const Skeleton bent = inRestPose(original(), {limbs.begin(), limbs.end()});
  expectTurnedBack(bent);
  expectTurnedBack(scaled(withOtherAxes(bent), 3));
}

TEST(TwinMatch, SoTheyAreOfOneWhoIsTurnedAnyhow) {
  for (const auto& limb : kBentLimbs) {
    SCOPED_TRACE(limb.first);
    expectTurnedBack(turnedAsAWhole(inRestPose(original(), {limb}), turn(Vec3(1, 2, -1), 77)));
  }
}

// An arm that rests otherwise, and whatever pose the source is in.
TEST(TwinMatch, AnyPoseIsTaken) {
  const Skeleton source = original(),
                 target = inRestPose(withOtherAxes(source), {{"mixamorig:LeftArm", turn(Vec3(0.3, 1, 0.2), 15)}});
  const std::optional<Twins> twins = matchTwins(source, target);
  ASSERT_TRUE(twins);
  Pose pose = restPose(source);
  pose.locals[source.find("mixamorig:RightUpLeg").value()].rotation = turn(Vec3(1, 0.2, 0), 50);
  pose.locals[source.find("mixamorig:Spine1").value()].rotation = turn(Vec3(0.2, 1, 0.5), 20);
  pose.locals[source.find("mixamorig:LeftForeArm").value()].rotation = turn(Vec3::UnitY(), -70);
  expectParallel(source, pose, target, *twins, poseAsTwin(source, pose, target, *twins));
}

TEST(TwinMatch, EqualRestPosesStay) {
  const Skeleton source = original(), target = withOtherAxes(source);
  const std::optional<Twins> twins = matchTwins(source, target);
  ASSERT_TRUE(twins);
  const Pose pose = poseAsTwin(source, restPose(source), target, *twins), rest = restPose(target);
  for (Index j = 0; j < target.jointCount(); ++j) {
    EXPECT_LT(pose.locals[j].rotation.angularDistance(rest.locals[j].rotation), 1e-7) << target.joints[j].name;
    EXPECT_EQ(pose.locals[j].translation, rest.locals[j].translation);
  }
}

}  // namespace
}  // namespace limber
