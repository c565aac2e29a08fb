#include "limber/rigging/person_template.h"

#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/rigging/body/testing/capsule_person.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

Index add(Skeleton& skeleton, const std::string& name, std::optional<Index> parent, const Vec3& position) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.rest.translation = parent ? Vec3(position - restGlobals(skeleton)[*parent].translation()) : position;
  skeleton.joints.push_back(joint);
  return skeleton.jointCount() - 1;
}

// A person with a root on the ground, twist joints, a finger, and arms that hang; 2 high, with short legs.
Skeleton hangingArms() {
  Skeleton skeleton;
  const Index root = add(skeleton, "Root", std::nullopt, {0, 0, 0});
  const Index hips = add(skeleton, "Hips", root, {0, 0.8, 0});
  const Index spine = add(skeleton, "Spine", hips, {0, 1, 0.02});
  const Index chest = add(skeleton, "Chest", spine, {0, 1.3, 0});
  const Index neck = add(skeleton, "Neck", chest, {0, 1.65, 0});
  add(skeleton, "Head", neck, {0, 1.75, 0});
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? ".L" : ".R";
    const Index shoulder = add(skeleton, "Shoulder" + side, chest, {s * 0.05, 1.6, 0});
    const Index arm = add(skeleton, "UpperArm" + side, shoulder, {s * 0.22, 1.55, 0});
    add(skeleton, "Sleeve" + side, arm, {s * 0.22, 1.35, 0.04});
    const Index fore = add(skeleton, "LowerArm" + side, arm, {s * 0.22, 1.15, 0});
    const Index twist = add(skeleton, "ForearmTwist" + side, fore, {s * 0.22, 1, 0});
    const Index hand = add(skeleton, "Hand" + side, twist, {s * 0.22, 0.8, 0});
    add(skeleton, "Middle1" + side, hand, {s * 0.22, 0.7, 0});
    const Index leg = add(skeleton, "UpperLeg" + side, hips, {s * 0.12, 0.75, 0});
    const Index shin = add(skeleton, "LowerLeg" + side, leg, {s * 0.12, 0.4, 0});
    add(skeleton, "Foot" + side, shin, {s * 0.12, 0.06, -0.02});
  }
  return skeleton;
}

AutoRig rigged(const Skeleton& own, const TriMesh& mesh, std::vector<JointPin> pins = {}) {
  RigOptions options;
  options.templateName = "mine";
  options.templateSkeleton = own;
  options.pins = std::move(pins);
  Progress progress;
  return rigWithTemplate(mesh, options, progress);
}

Vec3 positionOf(const Skeleton& skeleton, const std::string& name) {
  return restGlobals(skeleton)[skeleton.find(name).value()].translation();
}

// The same skeleton, turned as a whole.
Skeleton turned(Skeleton skeleton, const Quat& turn) {
  skeleton.joints[0].rest.rotation = turn * skeleton.joints[0].rest.rotation;
  return skeleton;
}

}  // namespace

TEST(PersonTemplate, FindsLimbsHoweverTheArmsAreHeld) {
  const Skeleton own = hangingArms();
  for (const double arms : {-0.1, 0.3, 0.8, 1.2}) {
    SCOPED_TRACE(arms);
    const testing::CapsulePerson body = testing::capsulePerson(arms);
    const AutoRig result = rigged(own, body.mesh);
    checkSkeleton(result.skeleton);
    EXPECT_EQ(result.matches[0].name, "mine");
    EXPECT_GT(result.matches[0].confidence, 0.7);
    ASSERT_EQ(result.skeleton.jointCount(), own.jointCount());
    for (Index j = 0; j < own.jointCount(); ++j) {
      EXPECT_EQ(result.skeleton.joints[j].name, own.joints[j].name);
      EXPECT_EQ(result.skeleton.joints[j].parent, own.joints[j].parent);
    }
    EXPECT_LT((positionOf(result.skeleton, "Hand.L") - body.hand).norm(), 0.05);
    EXPECT_LT((positionOf(result.skeleton, "LowerArm.L") - body.elbow).norm(), 0.05);
    EXPECT_LT((positionOf(result.skeleton, "Foot.L") - body.ankle).norm(), 0.05);
    EXPECT_LT((positionOf(result.skeleton, "UpperLeg.L") - body.hip).norm(), 0.05);
  }
}

// What plays no bone of a person goes along.
TEST(PersonTemplate, OtherJointsGoAlong) {
  const testing::CapsulePerson body = testing::capsulePerson(0);
  const Skeleton skeleton = rigged(hangingArms(), body.mesh).skeleton;
  EXPECT_LT(positionOf(skeleton, "Root").norm(), 0.05) << "on the ground";
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? ".L" : ".R";
    const Vec3 elbow = positionOf(skeleton, "LowerArm" + side), hand = positionOf(skeleton, "Hand" + side);
    EXPECT_LT((positionOf(skeleton, "ForearmTwist" + side) - (elbow + 3.0 / 7 * (hand - elbow))).norm(), 0.01);
    const Vec3 sleeve = positionOf(skeleton, "Sleeve" + side) - 0.5 * (positionOf(skeleton, "UpperArm" + side) + elbow);
    EXPECT_GT(sleeve.z(), 0.005) << "before the arm, as in the user's rest pose";
    EXPECT_LT(std::abs(sleeve.y()), 0.01);
    EXPECT_GT(s * positionOf(skeleton, "Middle1" + side).x(), s * hand.x() + 0.02) << "out with the hand";
  }
}

TEST(PersonTemplate, MayStandAnyWay) {
  const testing::CapsulePerson body = testing::capsulePerson();
  const Skeleton usual = rigged(hangingArms(), body.mesh).skeleton;
  for (const Vec3& axis : {Vec3::UnitX().eval(), Vec3::UnitY().eval()}) {
    const Quat turn(Eigen::AngleAxisd(EIGEN_PI / 2, axis));
    const Skeleton skeleton = rigged(turned(hangingArms(), turn), body.mesh).skeleton;
    for (const char* name : {"Hand.L", "Sleeve.R", "ForearmTwist.L", "Root"}) {
      EXPECT_LT((positionOf(skeleton, name) - positionOf(usual, name)).norm(), 0.01) << name;
    }
  }
}

TEST(PersonTemplate, KeepsPins) {
  const testing::CapsulePerson body = testing::capsulePerson();
  const Vec3 hand(0.36, 0.66, 0.02), twist(0.3, 0.7, 0.01);
  const Skeleton skeleton = rigged(hangingArms(), body.mesh, {{"Hand.L", hand}, {"ForearmTwist.L", twist}}).skeleton;
  EXPECT_LT((positionOf(skeleton, "Hand.L") - hand).norm(), 1e-6);
  EXPECT_LT((positionOf(skeleton, "ForearmTwist.L") - twist).norm(), 1e-6);
  EXPECT_THROW(rigged(hangingArms(), body.mesh, {{"Tail", twist}}), Error);
}

TEST(PersonTemplate, NamesTheUsersLimbsThatHaveNoPlace) {
  TriMesh ball;
  testing::addCapsule(ball, {0, 0.49, 0}, {0, 0.51, 0}, 0.49);
  const AutoRig result = rigged(hangingArms(), ball);
  EXPECT_LT(result.matches[0].confidence, 0.4);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.items().front().where.find("Hand.L"), std::string::npos);
}

TEST(PersonTemplate, IsNoneForAnimalsAndForParts) {
  Skeleton own = hangingArms();
  EXPECT_TRUE(personTemplate(own, templateFrom(own, "mine")));
  own.joints[*own.find("LowerLeg.R")].name = "Stick";
  EXPECT_TRUE(personTemplate(own, templateFrom(own, "mine"))) << "it lies where a shin does";
  own.joints.resize(*own.find("UpperLeg.R"));
  EXPECT_FALSE(personTemplate(own, templateFrom(own, "mine"))) << "on one leg";
  // On its hands and feet: the trunk level.
  own = hangingArms();
  const Index chest = *own.find("Chest");
  own.joints[chest].rest.translation = Vec3(0, -0.1, 0.5);
  for (const std::string side : {".L", ".R"}) {
    own.joints[*own.find("UpperArm" + side)].rest.translation.y() = -0.3;
  }
  EXPECT_FALSE(personTemplate(own, templateFrom(own, "mine")));
}

}  // namespace limber
