#include "limber/character/anatomy/half_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "limber/character/anatomy/names/joint_words.h"
#include "limber/character/anatomy/testing/bodies.h"
#include "limber/core/text/numbers.h"

namespace limber {
namespace {

using limber::testing::MadeBody;
using limber::testing::NameHabit;

HalfBody folded(const Skeleton& skeleton) {
  const JointTree tree(skeleton);
  return foldBody(tree, restPositions(skeleton));
}

// Each joint is in one half joint, and parents come first.
void expectWhole(const HalfBody& body, const Skeleton& skeleton) {
  std::vector<int> times(skeleton.jointCount(), 0);
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    const HalfJoint& half = body.joints[i];
    ++times[half.joint];
    if (half.partner) ++times[*half.partner];
    EXPECT_EQ(half.kind == HalfKind::kPair, half.partner.has_value());
    if (half.parent) {
      EXPECT_LT(*half.parent, i);
    }
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
}

const HalfJoint& halfOf(const HalfBody& body, Index joint) {
  return *std::find_if(body.joints.begin(), body.joints.end(),
                       [&](const HalfJoint& half) { return half.joint == joint || half.partner == joint; });
}

// Joints of a side are partners of those of the other side, all others lie in the plane.
void expectSidesPaired(const HalfBody& body, const MadeBody& made) {
  expectWhole(body, made.skeleton);
  EXPECT_TRUE(body.hasPairs);
  EXPECT_FALSE(body.sidesByName);
  EXPECT_GT(std::abs(body.lateral.x()), 0.999);
  for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
    const HalfJoint& half = halfOf(body, j);
    const std::string& name = made.skeleton.joints[j].name;
    if (made.parts[j].side == Side::kCenter) {
      EXPECT_EQ(half.kind, HalfKind::kMiddle) << name;
      continue;
    }
    ASSERT_TRUE(half.partner) << name;
    EXPECT_EQ(made.parts[half.joint].segment, made.parts[*half.partner].segment) << name;
    EXPECT_EQ(made.parts[half.joint].pair, made.parts[*half.partner].pair) << name;
    EXPECT_EQ(made.parts[half.joint].side, opposite(made.parts[*half.partner].side)) << name;
    EXPECT_EQ(made.parts[half.joint].side == Side::kLeft, body.lateral.x() > 0) << name << ": the first lies to it";
  }
}

TEST(HalfBody, PeopleAndAnimalsFoldAlongTheirMiddle) {
  for (const MadeBody& body : {limber::testing::personWith(NameHabit::kMixamo), limber::testing::dog(),
                               limber::testing::crow(), limber::testing::fish(), limber::testing::spider()}) {
    SCOPED_TRACE(body.skeleton.joints[0].name);
    const HalfBody half = folded(body.skeleton);
    expectSidesPaired(half, body);
    for (const HalfJoint& joint : half.joints) {
      EXPECT_LT((joint.at - restPositions(body.skeleton)[joint.joint]).norm(), 1e-9) << "mirror images";
    }
  }
}

TEST(HalfBody, PairedBonesAreWhatIsNotInTheMiddle) {
  const MadeBody person = limber::testing::personWith(NameHabit::kVrm);
  double all = 0, sides = 0;
  for (Index j = 0; j < person.skeleton.jointCount(); ++j) {
    if (!person.skeleton.joints[j].parent) continue;
    const double length = person.skeleton.joints[j].rest.translation.norm();
    all += length;
    if (person.parts[j].side == Side::kLeft) sides += length;
  }
  EXPECT_NEAR(folded(person.skeleton).pairedFraction, sides / all, 1e-9) << "counted once for both sides";
}

TEST(HalfBody, AnArmThatIsTurnedKeepsItsPartner) {
  MadeBody person = limber::testing::personWith(NameHabit::kMixamo);
  Joint& arm = person.skeleton.joints[person.skeleton.find("mixamorig:LeftArm").value()];
  for (const double degrees : {-30.0, -60.0, -90.0}) {
    arm.rest.rotation = Quat(Eigen::AngleAxisd(degrees * kPi / 180, Vec3::UnitZ()));
    SCOPED_TRACE(degrees);
    expectSidesPaired(folded(person.skeleton), person);
  }
}

TEST(HalfBody, AnyPlaneIsFound) {
  MadeBody person = limber::testing::personWith(NameHabit::kMixamo);
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(0.3, 1, 0.2).normalized()));
  const HalfBody upright = folded(person.skeleton),
                 turned = folded(limber::testing::turnedAsAWhole(person.skeleton, turn));
  EXPECT_NEAR(std::abs(turned.lateral.dot(turn * upright.lateral)), 1, 1e-6);
  EXPECT_NEAR(turned.pairedFraction, upright.pairedFraction, 1e-6);
}

TEST(HalfBody, WithoutPairsNothingHasASide) {
  const MadeBody snake = limber::testing::snake();
  const HalfBody half = folded(snake.skeleton);
  expectWhole(half, snake.skeleton);
  EXPECT_FALSE(half.hasPairs);
  for (const HalfJoint& joint : half.joints) EXPECT_EQ(joint.kind, HalfKind::kMiddle);
}

// An extra joint in one of two arms: the joints below it keep their partners.
TEST(HalfBody, ATwistJointOnOneSideShiftsNoPairs) {
  MadeBody person = limber::testing::personWith(NameHabit::kVrm);
  Skeleton longer;
  for (Joint joint : person.skeleton.joints) {
    if (joint.parent) joint.parent = longer.find(person.skeleton.joints[*joint.parent].name);
    if (joint.name == "leftLowerArm") {
      joint.rest.translation *= 0.5;
      limber::testing::addJoint(longer, "half", "leftUpperArm", joint.rest.translation);
      joint.parent = longer.jointCount() - 1;
    }
    longer.joints.push_back(joint);
  }
  const JointTree tree(longer);
  const HalfBody body = foldBody(tree, restPositions(longer), partnersByName(longer, wordsOfJoints(longer)));
  for (const char* part : {"UpperArm", "LowerArm", "Hand"}) {
    const Index left = longer.find(std::string("left") + part).value();
    EXPECT_EQ(halfOf(body, left).partner, longer.find(std::string("right") + part)) << part;
  }
}

// As of files whose rest pose has lost all lengths.
TEST(HalfBody, NamesPairJointsThatLieInOnePlace) {
  Skeleton person = limber::testing::personWith(NameHabit::kMixamo).skeleton;
  for (Joint& joint : person.joints) joint.rest.translation = Vec3::Zero();
  const std::vector<std::optional<NamedPartner>> named = partnersByName(person, wordsOfJoints(person));
  const JointTree tree(person);
  const HalfBody body = foldBody(tree, restPositions(person), named);
  expectWhole(body, person);
  std::size_t pairs = 0;
  for (const HalfJoint& half : body.joints) {
    if (!half.partner) continue;
    ++pairs;
    EXPECT_NE(person.joints[half.joint].name.find("Left"), std::string::npos) << "the left one is the first";
  }
  // Nothing of it has a length, and so no pair counts: without sides all are in the middle, else nine pairs.
  EXPECT_EQ(pairs, body.hasPairs ? 9u : 0u);
}

// Feet that rest at one position under a body that has its sides.
TEST(HalfBody, NamesPairFeetInOnePlace) {
  Skeleton person = limber::testing::personWith(NameHabit::kMixamo).skeleton;
  for (Joint& joint : person.joints) {
    if (joint.name.ends_with("UpLeg")) joint.rest.translation.x() = 0;
    if (joint.name.ends_with("ToeBase")) joint.rest.translation.x() = 0;
  }
  const JointTree tree(person);
  const HalfBody body = foldBody(tree, restPositions(person), partnersByName(person, wordsOfJoints(person)));
  expectWhole(body, person);
  for (const char* part : {"UpLeg", "Leg", "Foot", "ToeBase", "Arm", "Hand"}) {
    const HalfJoint& half = halfOf(body, person.find(std::string("mixamorig:Left") + part).value());
    EXPECT_EQ(half.partner, person.find(std::string("mixamorig:Right") + part)) << part;
    EXPECT_EQ(person.joints[half.joint].name, std::string("mixamorig:Left") + part);
  }
}

TEST(HalfBody, NothingAndOneJointHaveNoPairs) {
  EXPECT_TRUE(folded(Skeleton()).joints.empty());
  Skeleton one;
  limber::testing::addJoint(one, "one", "", Vec3(1, 2, 3));
  const HalfBody body = folded(one);
  ASSERT_EQ(body.joints.size(), 1u);
  EXPECT_FALSE(body.hasPairs);
}

}  // namespace
}  // namespace limber
