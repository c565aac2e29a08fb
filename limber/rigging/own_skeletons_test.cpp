// Users' skeletons fitted into bodies.
#include <string>

#include <gtest/gtest.h>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/core/error.h"
#include "limber/rigging/body/testing/capsule_animal.h"
#include "limber/rigging/body/testing/capsule_person.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

Index addAt(Skeleton& skeleton, const std::string& name, std::optional<Index> parent, const Vec3& position) {
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
  const Index root = addAt(skeleton, "Root", std::nullopt, {0, 0, 0});
  const Index hips = addAt(skeleton, "Hips", root, {0, 0.8, 0});
  const Index spine = addAt(skeleton, "Spine", hips, {0, 1, 0.02});
  const Index chest = addAt(skeleton, "Chest", spine, {0, 1.3, 0});
  const Index neck = addAt(skeleton, "Neck", chest, {0, 1.65, 0});
  addAt(skeleton, "Head", neck, {0, 1.75, 0});
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? ".L" : ".R";
    const Index shoulder = addAt(skeleton, "Shoulder" + side, chest, {s * 0.05, 1.6, 0});
    const Index arm = addAt(skeleton, "UpperArm" + side, shoulder, {s * 0.22, 1.55, 0});
    addAt(skeleton, "Sleeve" + side, arm, {s * 0.22, 1.35, 0.04});
    const Index fore = addAt(skeleton, "LowerArm" + side, arm, {s * 0.22, 1.15, 0});
    const Index twist = addAt(skeleton, "ForearmTwist" + side, fore, {s * 0.22, 1, 0});
    const Index hand = addAt(skeleton, "Hand" + side, twist, {s * 0.22, 0.8, 0});
    addAt(skeleton, "Middle1" + side, hand, {s * 0.22, 0.7, 0});
    const Index leg = addAt(skeleton, "UpperLeg" + side, hips, {s * 0.12, 0.75, 0});
    const Index shin = addAt(skeleton, "LowerLeg" + side, leg, {s * 0.12, 0.4, 0});
    addAt(skeleton, "Foot" + side, shin, {s * 0.12, 0.06, -0.02});
  }
  return skeleton;
}

AutoRig riggedWith(const Skeleton& own, const TriMesh& mesh, std::vector<JointPin> pins = {},
                   std::shared_ptr<RigMemory> memory = {}) {
  RigOptions options;
  options.memory = std::move(memory);
  options.templateName = "mine";
  options.templateSkeleton = own;
  options.pins = std::move(pins);
  Progress progress;
  return rigWithTemplate(mesh, options, progress);
}

Vec3 jointPosition(const Skeleton& skeleton, const std::string& name) {
  return restGlobals(skeleton)[skeleton.find(name).value()].translation();
}

// Measured once for all tests.
const testing::CapsulePerson& capsuleBody() {
  static const testing::CapsulePerson person = testing::capsulePerson();
  return person;
}
AutoRig inCapsuleBody(const Skeleton& own, std::vector<JointPin> pins = {}) {
  static const auto memory = std::make_shared<RigMemory>();
  return riggedWith(own, capsuleBody().mesh, std::move(pins), memory);
}

void expectSameTree(const Skeleton& skeleton, const Skeleton& own) {
  ASSERT_EQ(skeleton.jointCount(), own.jointCount());
  for (Index j = 0; j < own.jointCount(); ++j) {
    EXPECT_EQ(skeleton.joints[j].name, own.joints[j].name);
    EXPECT_EQ(skeleton.joints[j].parent, own.joints[j].parent);
  }
}

// Each bone about as long as its share of the body, and nothing far outside.
void expectInside(const Skeleton& skeleton, const TriMesh& mesh) {
  Box box;
  for (const Vec3f& position : mesh.positions) box.add(position.cast<double>());
  const double margin = 0.1 * box.longestSide();
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Vec3 position = globals[j].translation();
    EXPECT_TRUE((position.array() > box.min.array() - margin).all() &&
                (position.array() < box.max.array() + margin).all())
        << skeleton.joints[j].name << " " << position.transpose();
  }
}

}  // namespace

TEST(OwnSkeletons, LimbsAreFoundHoweverTheArmsAreHeld) {
  const Skeleton own = hangingArms();
  for (const double arms : {-0.1, 0.8}) {
    SCOPED_TRACE(arms);
    const testing::CapsulePerson person = testing::capsulePerson(arms);
    const AutoRig result = riggedWith(own, person.mesh);
    checkSkeleton(result.skeleton);
    expectSameTree(result.skeleton, own);
    expectInside(result.skeleton, person.mesh);
    EXPECT_EQ(result.matches[0].name, "mine");
    EXPECT_GT(result.matches[0].confidence, kLikelyTemplate);
    EXPECT_LT((jointPosition(result.skeleton, "Hand.L") - person.hand).norm(), 0.12);
    EXPECT_LT((jointPosition(result.skeleton, "LowerArm.L") - person.elbow).norm(), 0.12);
    EXPECT_LT((jointPosition(result.skeleton, "Foot.L") - person.ankle).norm(), 0.12);
    EXPECT_LT((jointPosition(result.skeleton, "UpperLeg.L") - person.hip).norm(), 0.12);
  }
}

// Joints that are none of the reading's lie as they do at rest, relative to the bones about them.
TEST(OwnSkeletons, OtherJointsGoAlong) {
  const testing::CapsulePerson person = testing::capsulePerson(0);
  const Skeleton skeleton = riggedWith(hangingArms(), person.mesh).skeleton;
  EXPECT_LT(jointPosition(skeleton, "Root").norm(), 0.1) << "on the ground";
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? ".L" : ".R";
    const Vec3 elbow = jointPosition(skeleton, "LowerArm" + side), hand = jointPosition(skeleton, "Hand" + side);
    EXPECT_LT((jointPosition(skeleton, "ForearmTwist" + side) - (elbow + 3.0 / 7 * (hand - elbow))).norm(), 0.01);
    const Vec3 sleeve =
        jointPosition(skeleton, "Sleeve" + side) - 0.5 * (jointPosition(skeleton, "UpperArm" + side) + elbow);
    EXPECT_GT(sleeve.z(), 0.005) << "before the arm, as in the user's rest pose";
    EXPECT_LT(std::abs(sleeve.y()), 0.02);
    EXPECT_GT(s * jointPosition(skeleton, "Middle1" + side).x(), s * hand.x() + 0.01) << "out with the hand";
  }
}

// Joints beyond a limb that nothing is read of keep to its last bone.
TEST(OwnSkeletons, AHatIsOnTheHead) {
  Skeleton own = hangingArms();
  const Index hat = addAt(own, "Hat", *own.find("Head"), {0, 1.95, 0});
  addAt(own, "Hat_feather", hat, {0, 2.0, -0.1});
  const Skeleton skeleton = inCapsuleBody(own).skeleton;
  expectInside(skeleton, capsuleBody().mesh);
  const Vec3 head = jointPosition(skeleton, "Head");
  EXPECT_GT(jointPosition(skeleton, "Hat").y(), head.y() + 0.03);
  EXPECT_LT((jointPosition(skeleton, "Hat") - head).norm(), 0.2);
  EXPECT_LT((jointPosition(skeleton, "Hat_feather") - head).norm(), 0.3);
}

TEST(OwnSkeletons, BonesOfLeavesGoOnAlongTheirLimbs) {
  const Skeleton skeleton = inCapsuleBody(hangingArms()).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (const char* side : {".L", ".R"}) {
    const Index hand = *skeleton.find(std::string("Hand") + side);
    const Vec3 arm = globals[hand].translation() - globals[*skeleton.joints[hand].parent].translation();
    EXPECT_GT(globals[hand].linear().col(1).dot(arm.normalized()), 0.5) << side;
  }
  EXPECT_GT(globals[*skeleton.find("Head")].linear()(1, 1), 0.5);
}

TEST(OwnSkeletons, MayHaveAnyOrientation) {
  const Skeleton usual = inCapsuleBody(hangingArms()).skeleton;
  for (const Vec3& axis : {Vec3::UnitX().eval(), Vec3::UnitY().eval()}) {
    const Skeleton own = testing::turnedAsAWhole(hangingArms(), testing::turn(axis, 90));
    const Skeleton skeleton = inCapsuleBody(own).skeleton;
    for (const char* name : {"Hand.L", "Sleeve.R", "ForearmTwist.L", "Root"}) {
      EXPECT_LT((jointPosition(skeleton, name) - jointPosition(usual, name)).norm(), 0.02) << name << axis.transpose();
    }
  }
}

TEST(OwnSkeletons, MayHaveAnyUnit) {
  const Skeleton usual = inCapsuleBody(hangingArms()).skeleton;
  Skeleton own = hangingArms();
  for (Joint& joint : own.joints) joint.rest.translation *= 100;
  const Skeleton skeleton = inCapsuleBody(own).skeleton;
  for (Index j = 0; j < own.jointCount(); ++j) {
    EXPECT_LT((jointPosition(skeleton, own.joints[j].name) - jointPosition(usual, own.joints[j].name)).norm(), 1e-3)
        << own.joints[j].name;
  }
}

TEST(OwnSkeletons, SidesOfASymmetricBodyMirrorEachOther) {
  const Skeleton skeleton = inCapsuleBody(hangingArms()).skeleton;
  for (const Joint& joint : skeleton.joints) {
    if (!joint.name.ends_with(".L")) continue;
    const std::string other = joint.name.substr(0, joint.name.size() - 2) + ".R";
    const Vec3 image = jointPosition(skeleton, other).cwiseProduct(Vec3(-1, 1, 1));
    EXPECT_LT((jointPosition(skeleton, joint.name) - image).norm(), 0.02) << joint.name;
  }
}

TEST(OwnSkeletons, KeepPins) {
  const Vec3 hand(0.36, 0.66, 0.02), twist(0.3, 0.7, 0.01), sleeve(0.17, 0.76, 0.03);
  const Skeleton skeleton =
      inCapsuleBody(hangingArms(), {{"Hand.L", hand}, {"ForearmTwist.L", twist}, {"Sleeve.L", sleeve}}).skeleton;
  EXPECT_LT((jointPosition(skeleton, "Hand.L") - hand).norm(), 1e-6);
  EXPECT_LT((jointPosition(skeleton, "ForearmTwist.L") - twist).norm(), 1e-6);
  EXPECT_LT((jointPosition(skeleton, "Sleeve.L") - sleeve).norm(), 1e-6);
  EXPECT_THROW(inCapsuleBody(hangingArms(), {{"Tail", twist}}), Error);
}

TEST(OwnSkeletons, LimbsThatHaveNoPlaceAreNamed) {
  TriMesh ball;
  testing::addCapsule(ball, {0, 0.49, 0}, {0, 0.51, 0}, 0.49);
  const AutoRig result = riggedWith(hangingArms(), ball);
  checkSkeleton(result.skeleton);
  EXPECT_LT(result.matches[0].confidence, kLikelyTemplate);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_EQ(result.warnings.items().front().kind, "no-place");
  EXPECT_NE(result.warnings.items().front().where.find("LowerArm.L"), std::string::npos)
      << result.warnings.items().front().where;
}

TEST(OwnSkeletons, AnimalsFitAnimals) {
  const Skeleton own = testing::dog().skeleton;
  const TriMesh hound = testing::capsuleHound();
  const AutoRig result = riggedWith(own, hound);
  checkSkeleton(result.skeleton);
  expectSameTree(result.skeleton, own);
  expectInside(result.skeleton, hound);
  EXPECT_GT(jointPosition(result.skeleton, "Head").z(), jointPosition(result.skeleton, "Pelvis").z());
  EXPECT_GT(jointPosition(result.skeleton, "L_Thigh").x(), jointPosition(result.skeleton, "R_Thigh").x());
  EXPECT_LT(jointPosition(result.skeleton, "L_Toe").y(), jointPosition(result.skeleton, "L_Thigh").y());
}

// Trunk and arms; the left collar as well as the right one is `collar` to the left.
Skeleton armsAlone(double collar, bool crossed) {
  Skeleton skeleton;
  const Index root = addAt(skeleton, "root", std::nullopt, {0, 1, 0});
  const Index neck = addAt(skeleton, "neck", root, {0, 1.45, 0});
  addAt(skeleton, "top", neck, {0, 1.75, 0});
  const Index left = addAt(skeleton, "LeftCollar", neck, {collar, 1.5, 0});
  const Index right = addAt(skeleton, "RightCollar", neck, {-collar, 1.5, 0});
  addAt(skeleton, "LeftHand", crossed ? right : left, {(crossed ? -collar : collar) + 0.7, 1.4, 0});
  addAt(skeleton, "RightHand", crossed ? left : right, {(crossed ? collar : -collar) - 0.7, 1.4, 0});
  return skeleton;
}

TEST(OwnSkeletons, SidesMayMeetOrCross) {
  for (const double collar : {0.0, 0.1}) {
    for (const bool crossed : {false, true}) {
      SCOPED_TRACE(collar);
      SCOPED_TRACE(crossed);
      const Skeleton skeleton = inCapsuleBody(armsAlone(collar, crossed)).skeleton;
      checkSkeleton(skeleton);
      EXPECT_GT(jointPosition(skeleton, "LeftHand").x(), 0.1);
      EXPECT_LT(jointPosition(skeleton, "RightHand").x(), -0.1);
      EXPECT_LT(std::abs(jointPosition(skeleton, "neck").x()), 0.03);
    }
  }
}

// Whoever brings a skeleton gets that one, whatever the shape tells; one that is no body fills the model.
TEST(OwnSkeletons, AreNeverReplaced) {
  Skeleton own;
  std::optional<Index> last;
  for (const auto& [name, y] : {std::pair{"base", 0.1}, {"middle", 0.5}, {"top", 1.0}})
    last = addAt(own, name, last, {0, y, 0});
  const TriMesh mesh = testing::capsuleSpider(4);
  const Skeleton skeleton = riggedWith(own, mesh).skeleton;
  expectSameTree(skeleton, own);
  expectInside(skeleton, mesh);
  EXPECT_GT((jointPosition(skeleton, "base") - jointPosition(skeleton, "top")).norm(), 0.02);
}

}  // namespace limber
