#include "limber/rigging/template_rigger.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/rigging/body/testing/capsule_animal.h"
#include "limber/rigging/body/testing/capsule_person.h"
#include "limber/rigging/roles/body_kinds.h"
#include "limber/rigging/testing/chair.h"

namespace limber {

namespace {

// Heights from where a body of capsules has a joint: the networks saw no such body.
constexpr double kNear = 0.12;

AutoRig rig(const TriMesh& mesh, const RigOptions& options) {
  Progress progress;
  return rigWithTemplate(mesh, options, progress);
}

RigOptions person() {
  RigOptions options;
  options.templateName = "humanoid";
  return options;
}

// Rigged once for all tests.
const AutoRig& riggedPerson() {
  static const AutoRig result = rig(testing::capsulePerson().mesh, person());
  return result;
}

Vec3 positionOf(const Skeleton& skeleton, const char* name) {
  return restGlobals(skeleton)[skeleton.find(name).value()].translation();
}

// Empty without such a warning.
std::string whereOf(const AutoRig& result, std::string_view kind) {
  for (const Warning& warning : result.warnings.items()) {
    if (warning.kind == kind) return warning.where;
  }
  return {};
}

bool warnsOf(const AutoRig& result, std::string_view kind) {
  const std::vector<Warning>& all = result.warnings.items();
  return std::any_of(all.begin(), all.end(), [&](const Warning& warning) { return warning.kind == kind; });
}

TriMesh ball() {
  TriMesh mesh;
  testing::addCapsule(mesh, {0, 0.49, 0}, {0, 0.51, 0}, 0.49);
  return mesh;
}

// Measured once for all tests.
AutoRig rigBall(RigOptions options) {
  static const auto memory = std::make_shared<RigMemory>();
  options.memory = memory;
  return rig(ball(), options);
}

}  // namespace

TEST(TemplateRigger, SpecksAboutAPersonDoNotCount) {
  TriMesh mesh = testing::capsulePerson().mesh;
  const Index bodyTriangles = mesh.triangleCount();
  for (const Vec3& speck : {Vec3(1.2, -0.6, 0.3), Vec3(-0.9, 1.7, 0), Vec3(0, -0.8, -0.5)}) {
    testing::addCapsule(mesh, speck, speck + Vec3(0, 0.01, 0), 0.01);
  }
  const AutoRig result = rig(mesh, person());
  EXPECT_TRUE(warnsOf(result, "stray-pieces"));
  EXPECT_EQ(result.warnings.items().front().count, mesh.triangleCount() - bodyTriangles);
  for (const char* joint : {"head", "leftHand", "rightToes", "hips"}) {
    EXPECT_LT((positionOf(result.skeleton, joint) - positionOf(riggedPerson().skeleton, joint)).norm(), 0.02) << joint;
  }
}

TEST(TemplateRigger, NamesTheJointsOfAPerson) {
  const testing::CapsulePerson body = testing::capsulePerson();
  const AutoRig& result = riggedPerson();
  checkSkeleton(result.skeleton);
  EXPECT_EQ(result.skeleton.jointCount(), 22u);
  EXPECT_LT((positionOf(result.skeleton, "leftHand") - body.hand).norm(), kNear);
  EXPECT_LT((positionOf(result.skeleton, "rightFoot") - body.ankle.cwiseProduct(Vec3(-1, 1, 1))).norm(), kNear);
  EXPECT_LT((positionOf(result.skeleton, "leftUpperLeg") - body.hip).norm(), kNear);
  EXPECT_TRUE(result.warnings.empty());
  ASSERT_EQ(result.matches.size(), 1u);
  EXPECT_EQ(result.matches[0].name, "humanoid");
  EXPECT_GT(result.matches[0].confidence, kLikelyTemplate);
  EXPECT_FALSE(result.isAbstained);
}

// As animals on two legs have them: knees before, hocks behind, toes on the ground. The networks see no hock in capsules.
TEST(TemplateRigger, KneesAndToesOfLegsThatBendBackAreFound) {
  const testing::CapsulePerson body = testing::capsulePerson(0.3, testing::CapsuleLegs::kHocked);
  const AutoRig result = rig(body.mesh, person());
  EXPECT_GT(result.matches[0].confidence, kLikelyTemplate);
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? "left" : "right";
    const auto off = [&](const char* joint, const Vec3& there) {
      return (positionOf(result.skeleton, (side + joint).c_str()) - there.cwiseProduct(Vec3(s, 1, 1))).norm();
    };
    EXPECT_LT(off("LowerLeg", body.knee), kNear);
    EXPECT_LT(off("Toes", body.toes), kNear);
  }
}

// A toy: stumps for legs, and a head that is half of it.
TEST(TemplateRigger, FindsTheLimbsOfAToy) {
  TriMesh toy;
  testing::addCapsule(toy, {0, 0.2, 0}, {0, 0.32, 0}, 0.12);
  testing::addCapsule(toy, {0, 0.68, 0}, {0, 0.7, 0}, 0.3);
  for (const double s : {1.0, -1.0}) {
    testing::addCapsule(toy, {s * 0.09, 0.07, 0}, {s * 0.09, 0.2, 0}, 0.07);
    testing::addCapsule(toy, {s * 0.08, 0.34, 0}, {s * 0.4, 0.34, 0}, 0.05);
  }
  RigOptions options = person();
  options.up = Vec3::UnitY();
  options.front = Vec3::UnitZ();
  const Skeleton skeleton = rig(toy, options).skeleton;
  EXPECT_LT(positionOf(skeleton, "leftUpperLeg").y(), 0.3);
  EXPECT_LT(positionOf(skeleton, "leftFoot").y(), 0.15);
  EXPECT_LT(std::abs(positionOf(skeleton, "leftFoot").x() - 0.09), kNear);
  EXPECT_LT(positionOf(skeleton, "leftUpperArm").y(), 0.5);
  EXPECT_GT(positionOf(skeleton, "leftHand").x(), 0.2);
  EXPECT_LT(std::abs(positionOf(skeleton, "leftHand").y() - 0.34), kNear);
  EXPECT_GT(positionOf(skeleton, "head").y(), 0.35);
}

TEST(TemplateRigger, JointsPointAlongTheirBones) {
  const Skeleton& skeleton = riggedPerson().skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (const auto& [joint, child] : {std::pair("hips", "spine"), std::pair("leftUpperArm", "leftLowerArm"),
                                     std::pair("rightLowerLeg", "rightFoot"), std::pair("upperChest", "neck")}) {
    const Vec3 bone = (positionOf(skeleton, child) - positionOf(skeleton, joint)).normalized();
    EXPECT_LT((globals[skeleton.find(joint).value()].linear().col(1) - bone).norm(), 1e-6) << joint;
  }
  for (const char* name : {"UpperArm", "LowerArm", "Hand", "UpperLeg", "Foot", "Toes"}) {
    const Mat3 left = globals[skeleton.find(std::string("left") + name).value()].linear();
    const Mat3 right = globals[skeleton.find(std::string("right") + name).value()].linear();
    const Vec3 turn(-1, 1, 1);
    constexpr double kSinglePrecision = 1e-5;  // that of the mesh and the networks
    EXPECT_LT((left.col(1) - right.col(1).cwiseProduct(turn)).norm(), kSinglePrecision) << name;
    EXPECT_LT((left.col(2) - right.col(2).cwiseProduct(turn)).norm(), kSinglePrecision) << name;
    EXPECT_NEAR(left.determinant(), 1, 1e-9);
  }
  EXPECT_GT(globals[skeleton.find("leftUpperArm").value()].linear()(2, 2), 0.9);  // +Z to the front
}

TEST(TemplateRigger, FollowsAModelThatStandsAnotherWay) {
  const testing::CapsulePerson body = testing::capsulePerson();
  Mat3 turn;  // +Z up, facing -Y: as modelling programs have it
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  TriMesh lying = body.mesh;
  for (Vec3f& p : lying.positions) p = turn.cast<float>() * p;
  EXPECT_LT((positionOf(rig(lying, person()).skeleton, "leftHand") - turn * body.hand).norm(), kNear);

  const Mat3 about = Eigen::AngleAxisd(EIGEN_PI, Vec3::UnitY()).toRotationMatrix();
  TriMesh away = body.mesh;
  for (Vec3f& p : away.positions) p = about.cast<float>() * p;
  RigOptions options = person();
  options.up = Vec3::UnitY();
  options.front = -Vec3::UnitZ();
  EXPECT_LT((positionOf(rig(away, options).skeleton, "leftHand") - about * body.hand).norm(), kNear);
}

TEST(TemplateRigger, SidesOfASymmetricBodyMirrorEachOther) {
  const Skeleton& skeleton = riggedPerson().skeleton;
  for (const Joint& joint : skeleton.joints) {
    if (!joint.name.starts_with("left")) continue;
    const Vec3 image = positionOf(skeleton, ("right" + joint.name.substr(4)).c_str()).cwiseProduct(Vec3(-1, 1, 1));
    EXPECT_LT((positionOf(skeleton, joint.name.c_str()) - image).norm(), 0.02) << joint.name;
  }
}

TEST(TemplateRigger, KeepsPins) {
  RigOptions options = person();
  options.pins = {{"leftHand", {0.4, 0.66, 0.03}}};
  const Skeleton skeleton = rig(testing::capsulePerson().mesh, options).skeleton;
  EXPECT_LT((positionOf(skeleton, "leftHand") - Vec3(0.4, 0.66, 0.03)).norm(), 1e-6);
  for (const std::vector<JointPin>& wrong : {std::vector<JointPin>{{"tail", Vec3::Zero()}},
                                             {{"head", {0, 150, 0}}},
                                             {{"head", {0, 0.9, 0}}, {"head", {0, 1, 0}}}}) {
    options.pins = wrong;
    EXPECT_THROW(rig(testing::capsulePerson().mesh, options), Error) << wrong.front().joint;
  }
}

// Where the bone of a joint ends: no joint, and not where the joint above is.
TEST(TemplateRigger, PinnedTipsTurnTheirBones) {
  RigOptions options = person();
  options.pins = {{"headTip", {0, 0.95, 0.2}}};
  const Skeleton skeleton = rig(testing::capsulePerson().mesh, options).skeleton;
  ASSERT_EQ(skeleton.jointCount(), riggedPerson().skeleton.jointCount());
  EXPECT_FALSE(skeleton.find("headTip"));
  const Vec3 head = positionOf(skeleton, "head");
  EXPECT_LT((head - positionOf(riggedPerson().skeleton, "head")).norm(), 0.05);
  const Vec3 bone = restGlobals(skeleton)[*skeleton.find("head")].linear().col(1);
  EXPECT_GT(bone.dot((Vec3(0, 0.95, 0.2) - head).normalized()), 0.999);
}

TEST(TemplateRigger, SaysWhereAPersonHasNoPlace) {
  const AutoRig result = rigBall(person());
  EXPECT_LT(result.matches[0].confidence, kLikelyTemplate);
  EXPECT_TRUE(warnsOf(result, "low-confidence"));
  EXPECT_NE(whereOf(result, "no-place").find("leftUpperLeg to leftToes"), std::string::npos);
  EXPECT_NE(whereOf(result, "no-place").find("rightHand"), std::string::npos);
  checkSkeleton(result.skeleton);
}

// Handles then, as many as suit it, and what is likeliest is told; who asks for a template gets it.
TEST(TemplateRigger, AbstainsWhereNoTemplateIsLikely) {
  RigOptions options;
  const AutoRig result = rigBall(options);
  EXPECT_TRUE(result.isAbstained);
  EXPECT_TRUE(warnsOf(result, "no-template"));
  ASSERT_FALSE(result.matches.empty());
  EXPECT_LT(result.matches[0].confidence, kLikelyTemplate);
  ASSERT_FALSE(result.suggestions.empty());
  EXPECT_EQ(result.skeleton.jointCount(), result.suggestions[0].handles);
  options.mayAbstain = false;
  EXPECT_FALSE(rigBall(options).isAbstained);
  EXPECT_FALSE(rigBall(person()).isAbstained);
  EXPECT_FALSE(rig(testing::capsulePerson().mesh, RigOptions()).isAbstained);
}

// What is missing is cut off by a plane.
AutoRig riggedPartOfAPerson(bool (*keep)(const Vec3f&)) {
  TriMesh mesh = testing::capsulePerson().mesh;
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](Index v) { return !keep(mesh.positions[v]); });
  });
  return rig(mesh, person());
}

TEST(TemplateRigger, SaysWhichLimbsHalfABodyLacks) {
  const AutoRig upper = riggedPartOfAPerson([](const Vec3f& p) { return p.y() > 0.52f; });
  EXPECT_NE(whereOf(upper, "no-place").find("leftUpperLeg to leftToes"), std::string::npos);
  EXPECT_NE(whereOf(upper, "no-place").find("rightUpperLeg to rightToes"), std::string::npos);
  const AutoRig armless = riggedPartOfAPerson([](const Vec3f& p) { return std::abs(p.x()) < 0.15f; });
  EXPECT_NE(whereOf(armless, "no-place").find("leftShoulder to leftHand"), std::string::npos);
  EXPECT_LT(armless.matches[0].confidence, riggedPerson().matches[0].confidence);
}

// Ends of limbs, one of a pair.
TEST(TemplateRigger, DoubtsAreFew) {
  for (const AutoRig& result : {riggedPerson(), rigBall(person())}) {
    EXPECT_LE(result.doubts.size(), kMaxDoubts);
    for (const std::string& doubt : result.doubts) {
      EXPECT_TRUE(result.skeleton.find(doubt)) << doubt;
      EXPECT_EQ(std::count(result.doubts.begin(), result.doubts.end(), doubt), 1);
      EXPECT_FALSE(doubt.starts_with("right")) << doubt;
    }
  }
}

TEST(TemplateRigger, WhatIsPinnedIsNoLongerInDoubt) {
  RigOptions options = person();
  const AutoRig first = rigBall(options);
  ASSERT_FALSE(first.doubts.empty());
  options.pins.push_back({first.doubts[0], {0, 0.9, 0}});
  for (const std::string& doubt : rigBall(options).doubts) EXPECT_NE(doubt, first.doubts[0]);
}

TEST(TemplateRigger, WithMemoryItGivesTheSame) {
  RigOptions options = person();
  options.pins.push_back({"leftHand", testing::capsulePerson().hand});
  const AutoRig fresh = rig(testing::capsulePerson().mesh, options);
  options.memory = std::make_shared<RigMemory>();
  for (int round = 0; round < 2; ++round) {
    const AutoRig again = rig(testing::capsulePerson().mesh, options);
    ASSERT_EQ(again.skeleton.jointCount(), fresh.skeleton.jointCount());
    for (Index j = 0; j < fresh.skeleton.jointCount(); ++j) {
      EXPECT_EQ(again.skeleton.joints[j].rest.translation, fresh.skeleton.joints[j].rest.translation);
    }
  }
  EXPECT_TRUE(options.memory->measured);
}

// A person fits into its seat, and leaves all else as it is.
TEST(TemplateRigger, AChairIsNoPerson) {
  const TriMesh chair = testing::chair();
  RigOptions options = person();
  options.memory = std::make_shared<RigMemory>();
  const AutoRig result = rig(chair, options);
  EXPECT_LT(result.matches[0].confidence, kLikelyTemplate);
  EXPECT_TRUE(warnsOf(result, "low-confidence"));
  options.templateName = "auto";
  EXPECT_TRUE(rig(chair, options).isAbstained);
}

TEST(TemplateRigger, FindsTheTemplate) {
  RigOptions options;
  const AutoRig result = rig(testing::capsulePerson().mesh, options);
  EXPECT_TRUE(result.matches[0].name.starts_with("humanoid")) << result.matches[0].name;
  EXPECT_GT(result.matches[0].confidence, kLikelyTemplate);
  for (std::size_t i = 1; i < result.matches.size(); ++i) {
    EXPECT_LE(result.matches[i].confidence, result.matches[i - 1].confidence);
  }
  options.templateName = "centaur";
  EXPECT_THROW(rigBall(options), Error);
  EXPECT_THROW(checkTemplateName("centaur"), Error);
  checkTemplateName("auto");
}

// Whatever the body is: a skeleton with finite joints, and what does not suit it is said.
TEST(TemplateRigger, EveryTemplateFitsEveryBody) {
  for (const TriMesh& mesh : {testing::capsulePerson().mesh, testing::capsuleSpider(3)}) {
    RigOptions options;
    options.memory = std::make_shared<RigMemory>();
    for (const BodyKind& named : bodyKinds()) {
      SCOPED_TRACE(named.name);
      checkTemplateName(named.name);
      options.templateName = std::string(named.name);
      const AutoRig result = rig(mesh, options);
      checkSkeleton(result.skeleton);
      EXPECT_FALSE(result.isAbstained);
      ASSERT_EQ(result.matches.size(), 1u);
      EXPECT_EQ(result.matches[0].name, named.name);
      EXPECT_EQ(warnsOf(result, "low-confidence"), result.matches[0].confidence < kLikelyTemplate);
      // Its first joint can be pinned by the name that it has.
      const Joint& first = result.skeleton.joints.front();
      options.pins = {{first.name, first.rest.translation + Vec3(0, 0.02, 0)}};
      const Skeleton pinned = rig(mesh, options).skeleton;
      EXPECT_LT((pinned.joints.front().rest.translation - options.pins[0].position).norm(), 1e-6);
      options.pins.clear();
    }
  }
}

AutoRig autoRigged(const TriMesh& mesh, RigOptions options = {}) {
  return rig(prepareMesh(mesh.positions, mesh.triangles).mesh, options);
}

void expectKind(const TriMesh& mesh, const std::string& name) {
  SCOPED_TRACE(name);
  const AutoRig result = autoRigged(mesh);
  EXPECT_FALSE(result.isAbstained);
  EXPECT_EQ(result.matches[0].name, name);
  EXPECT_GT(result.matches[0].confidence, kLikelyTemplate);
  checkSkeleton(result.skeleton);
}

TEST(TemplateRigger, TakesTheKindThatTheShapeTells) {
  expectKind(testing::capsuleTheropod(), "dinosaur");
  expectKind(testing::capsuleFish(), "fish");
  expectKind(testing::capsuleSnake(), "serpent");
  expectKind(testing::capsuleHound(), "quadruped");
}

TEST(TemplateRigger, CountsPairsOfLegs) {
  expectKind(testing::capsuleSpider(3), "insect");
}

// Its up is +Y, though flat and round as it is the networks hardly tell.
TEST(TemplateRigger, ExpectsTheUpsThatFilesHave) {
  expectKind(testing::capsuleSpider(4), "spider");
}

// Joints with a role, and joints along several.
TEST(TemplateRigger, KindsOfBodiesKeepPins) {
  RigOptions options;
  options.templateName = "serpent";
  const Vec3 pinned(0, 0.25, 0.3);
  options.pins = {{"chest", pinned}};
  const AutoRig result = autoRigged(testing::capsuleSnake(), options);
  EXPECT_LT((positionOf(result.skeleton, "chest") - pinned).norm(), 1e-9);
  options.pins = {{"leftPaw", pinned}};
  EXPECT_THROW(autoRigged(testing::capsuleSnake(), options), Error);
}

// Pinned joints tell which kind is meant.
TEST(TemplateRigger, TakesAKindThatHasThePinnedJoints) {
  RigOptions options;
  const Vec3 pinned(0.1, 0.2, -0.2);
  options.pins = {{"leftHindLowerLeg", pinned}};
  const Skeleton skeleton = rig(testing::capsulePerson().mesh, options).skeleton;
  EXPECT_LT((positionOf(skeleton, "leftHindLowerLeg") - pinned).norm(), 1e-6);
}

TEST(TemplateRigger, HandsTellWhetherThereAreFingers) {
  testing::CapsulePerson shape = testing::capsulePerson();
  EXPECT_EQ(rig(shape.mesh, {}).matches[0].name, "humanoid");
  const Vec3 along = (shape.hand - shape.elbow).normalized();
  for (const double side : {1.0, -1.0}) {
    for (const double z : {-0.027, -0.009, 0.009, 0.027}) {
      const Vec3 knuckle = shape.hand + 0.06 * along + Vec3(0, 0, z), tip = knuckle + 0.08 * along;
      testing::addCapsule(shape.mesh, knuckle.cwiseProduct(Vec3(side, 1, 1)), tip.cwiseProduct(Vec3(side, 1, 1)),
                          0.007);
    }
  }
  const AutoRig fingered = rig(shape.mesh, {});
  EXPECT_EQ(fingered.matches[0].name, "humanoid-fingers");
  EXPECT_GT(fingered.matches[0].confidence, kLikelyTemplate);
  EXPECT_TRUE(fingered.skeleton.find("leftIndexProximal"));
}

TEST(TemplateRigger, IsTheSameOnOneThread) {
  const AutoRig& many = riggedPerson();
  setThreadCount(1);
  const AutoRig one = rig(testing::capsulePerson().mesh, person());
  setThreadCount(0);
  for (Index j = 0; j < many.skeleton.jointCount(); ++j) {
    EXPECT_EQ(many.skeleton.joints[j].rest.translation, one.skeleton.joints[j].rest.translation);
  }
}

}  // namespace limber
