#include "limber/character/anatomy/body_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "limber/character/anatomy/testing/bodies.h"

namespace limber {
namespace {

using limber::testing::inRestPose;
using limber::testing::turn;
using limber::testing::vrmPerson;
using limber::testing::withJointBefore;

constexpr AnatomyOptions kByForm{false, {}};

// Names of joints are not looked at: those of VRM say what is right. Returns how many of its main
// bones were found.
std::size_t expectRight(const Skeleton& skeleton) {
  const BodyPieces body(skeleton, kByForm);
  const auto nameAt = [&](Index joint) { return skeleton.joints[joint].name; };
  std::size_t found = 0;
  const auto expectNamed = [&](Index joint, const std::string& bone) {
    EXPECT_EQ(nameAt(joint), bone);
    ++found;
  };
  if (body.pelvis) expectNamed(*body.pelvis, "hips");
  if (body.head) expectNamed(*body.head, "head");
  if (!body.neck.empty()) expectNamed(body.neck.front(), "neck");
  found += body.trunk.size();
  for (const LimbPieces& limb : body.limbs) {
    if (limb.part->kind != PartKind::kArm && limb.part->kind != PartKind::kLeg) continue;
    for (const auto& [segment, at] : limb.marks) {
      expectNamed(limb.joints[at], nameOf({limb.part->kind, limb.part->side, limb.part->pair, segment, 0}));
    }
  }
  return found;
}

Skeleton onAnkles(const Skeleton& skeleton) {
  Skeleton shorter = skeleton;
  std::erase_if(shorter.joints, [](const Joint& joint) { return joint.name.find("Toes") != std::string::npos; });
  for (Joint& joint : shorter.joints) {
    if (joint.parent) joint.parent = shorter.find(skeleton.joints[*joint.parent].name);
  }
  return shorter;
}

TEST(BodyPieces, APersonByForm) {
  EXPECT_GE(expectRight(vrmPerson()), 17u);
}

TEST(BodyPieces, HalfWayJointsDoNotMislead) {
  Skeleton person = vrmPerson();
  for (const std::string side : {"left", "right"}) {  // a hand that ends an arm might be its fingers
    const double x = side == "left" ? 1 : -1;
    limber::testing::addJoint(person, side + "Finger", side + "Hand", Vec3(0.09 * x, 0, 0));
    limber::testing::addJoint(person, side + "Tip", side + "Finger", Vec3(0.05 * x, 0, 0));
  }
  for (const char* end : {"leftLowerArm", "rightLowerArm", "leftLowerLeg", "rightLowerLeg", "leftHand", "rightHand"}) {
    person = withJointBefore(person, end, std::string("twist_") + end);
  }
  EXPECT_GE(expectRight(person), 17u);
}

TEST(BodyPieces, BentKneesTellTheFront) {
  Skeleton person = onAnkles(vrmPerson());
  for (const char* side : {"left", "right"}) {
    const std::string name(side);
    person = inRestPose(person,
                        {{name + "UpperLeg", turn(-Vec3::UnitX(), 20)}, {name + "LowerLeg", turn(Vec3::UnitX(), 40)}});
  }
  expectRight(person);
  for (Joint& joint : person.joints) {  // the same person seen from behind: few files face that direction
    if (!joint.parent) joint.rest.rotation = turn(Vec3::UnitY(), 180);
  }
  const Anatomy behind = readAnatomy(limber::testing::nameless(person));
  EXPECT_TRUE(behind.axes.front.z() < 0 || behind.confidence < 0.95) << "not right, and sure";
}

// As of a dinosaur without toes.
TEST(BodyPieces, AHeadFarAheadTellsTheFrontWhereHocksBendBackward) {
  Skeleton leaning = inRestPose(onAnkles(vrmPerson()), {{"spine", turn(Vec3::UnitX(), 80)}});
  for (const char* side : {"left", "right"}) {
    const std::string name(side);
    leaning = inRestPose(leaning,
                         {{name + "UpperLeg", turn(Vec3::UnitX(), 20)}, {name + "LowerLeg", turn(-Vec3::UnitX(), 40)}});
  }
  const BodyPieces body(leaning, kByForm);
  const Part* leg = body.anatomy.find(PartKind::kLeg, Side::kLeft);
  ASSERT_TRUE(leg && leg->middle);
  EXPECT_EQ(leaning.joints[*leg->middle].name, "leftLowerLeg");
}

TEST(BodyPieces, ATrunkThatLeansMayHangBesideArmsAndLegs) {
  Skeleton person = inRestPose(vrmPerson(), {{"spine", turn(Vec3::UnitX(), 80)}});
  const std::vector<Affine> globals = restGlobals(person);
  const Index hips = person.find("hips").value();
  for (const char* shoulder : {"leftShoulder", "rightShoulder"}) {
    const Index joint = person.find(shoulder).value();
    person.joints[joint].parent = hips;
    person.joints[joint].rest.translation = globals[joint].translation() - globals[hips].translation();
  }
  expectRight(person);
  const BodyPieces body(person, kByForm);
  EXPECT_GE(body.trunk.size(), 2u);
  EXPECT_FALSE(body.neck.empty());
  EXPECT_TRUE(body.head);
}

// A joint called hips that carries them all is the pelvis, though legs and spine part below it.
TEST(BodyPieces, HipsByNameMayCarryAPelvis) {
  Skeleton person = vrmPerson();
  for (Joint& joint : person.joints) joint.parent = joint.parent ? *joint.parent + 1 : 0;
  person.joints[0].name = "body";
  person.joints.insert(person.joints.begin(), Joint{"Hips", std::nullopt, {}, 0});
  const BodyPieces body(person);
  EXPECT_EQ(body.pelvis, Index{0});
  EXPECT_EQ(body.trunk.back(), person.find("upperChest"));
}

// Of all parts of that kind.
double minConfidence(const Skeleton& skeleton, PartKind kind, bool names = false) {
  const BodyPieces body(skeleton, {names, {}});
  double least = 1;
  for (const Part& part : body.anatomy.parts) {
    if (part.kind == kind) least = std::min(least, part.confidence);
  }
  return least;
}

constexpr PartKind kMainParts[] = {PartKind::kTrunk, PartKind::kArm, PartKind::kLeg, PartKind::kHead};

TEST(BodyPieces, ACleanPersonIsSure) {
  for (const PartKind kind : kMainParts) {
    EXPECT_GE(minConfidence(vrmPerson(), kind), kDoubtful) << nameOf(kind);
    EXPECT_GE(minConfidence(vrmPerson(), kind, true), kDoubtful) << nameOf(kind);
  }
  EXPECT_LT(minConfidence(vrmPerson(), PartKind::kArm), minConfidence(vrmPerson(), PartKind::kArm, true))
      << "a name says more";
}

TEST(BodyPieces, ATailIsOne) {
  Skeleton tailed = vrmPerson();
  limber::testing::addJoint(tailed, "b1", "hips", Vec3(0, 0.1, -0.45));
  limber::testing::addJoint(tailed, "b2", "b1", Vec3(0, 0, -0.45));
  const BodyPieces body(tailed, kByForm);
  const LimbPieces* tail = body.find(PartKind::kTail, Side::kCenter, 0);
  ASSERT_TRUE(tail);
  EXPECT_EQ(tail->joints, (std::vector<Index>{tailed.find("b1").value(), tailed.find("b2").value()}));
  expectRight(tailed);
}

// A person's form is then the same from the front and the back.
TEST(BodyPieces, WithoutToesLeftIsAGuess) {
  const Skeleton person = onAnkles(vrmPerson());
  EXPECT_LT(minConfidence(person, PartKind::kLeg), minConfidence(vrmPerson(), PartKind::kLeg));
  EXPECT_GE(minConfidence(person, PartKind::kTrunk), kDoubtful);
}

TEST(BodyPieces, OddArmsAreLessSure) {
  Skeleton person = vrmPerson();
  for (Joint& joint : person.joints) {
    if (joint.name == "leftHand" || joint.name == "rightHand") joint.rest.translation *= 0.3;
  }
  EXPECT_LT(minConfidence(person, PartKind::kArm), minConfidence(vrmPerson(), PartKind::kArm));
  EXPECT_GE(minConfidence(person, PartKind::kLeg), kDoubtful);
}

TEST(BodyPieces, LimbsAreMeasuredFromWhereTheyHang) {
  const Skeleton person = vrmPerson();
  const BodyPieces body(person);
  const LimbPieces* leg = body.find(PartKind::kLeg, Side::kLeft, 0);
  ASSERT_TRUE(leg);
  ASSERT_EQ(leg->along.size(), leg->joints.size());
  EXPECT_EQ(leg->along.front(), 0);
  EXPECT_NEAR(leg->along.back(), 1, 1e-12);
  EXPECT_TRUE(std::is_sorted(leg->along.begin(), leg->along.end()));
  EXPECT_EQ(leg->marks.front(), (std::pair<Segment, std::size_t>{Segment::kUpper, 0}));
  const LimbPieces* arm = body.find(PartKind::kArm, Side::kRight, 0);
  ASSERT_TRUE(arm);
  EXPECT_EQ(arm->marks.front().first, Segment::kBase);
  EXPECT_EQ(arm->marks[1], (std::pair<Segment, std::size_t>{Segment::kUpper, 1}));
  EXPECT_FALSE(body.find(PartKind::kTail, Side::kCenter, 0));
}

}  // namespace
}  // namespace limber
