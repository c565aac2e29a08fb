#include "limber/rigging/template_rigger.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/parallel.h"
#include "limber/rigging/body/testing/capsule_animal.h"
#include "limber/rigging/body/testing/capsule_person.h"

namespace limber {

namespace {

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
  EXPECT_LT((positionOf(result.skeleton, "leftHand") - body.hand).norm(), 0.08);
  EXPECT_LT((positionOf(result.skeleton, "rightFoot") - body.ankle.cwiseProduct(Vec3(-1, 1, 1))).norm(), 0.05);
  EXPECT_LT((positionOf(result.skeleton, "leftUpperLeg") - body.hip).norm(), 0.05);
  EXPECT_TRUE(result.warnings.empty());
  ASSERT_EQ(result.matches.size(), 1u);
  EXPECT_GT(result.matches[0].confidence, 0.7);
}

// As animals on two legs have them: knees before, hocks behind, toes on the ground.
TEST(TemplateRigger, FeetAreAtTheHocksOfLegsThatBendBack) {
  const testing::CapsulePerson body = testing::capsulePerson(0.3, testing::CapsuleLegs::kHocked);
  const AutoRig result = rig(body.mesh, person());
  EXPECT_GT(result.matches[0].confidence, 0.5);
  for (const double s : {1.0, -1.0}) {
    const std::string side = s > 0 ? "left" : "right";
    const auto off = [&](const char* joint, const Vec3& there) {
      return (positionOf(result.skeleton, (side + joint).c_str()) - there.cwiseProduct(Vec3(s, 1, 1))).norm();
    };
    EXPECT_LT(off("LowerLeg", body.knee), 0.06);
    EXPECT_LT(off("Foot", body.ankle), 0.04);
    EXPECT_LT(off("Toes", body.toes), 0.05);
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
  EXPECT_LT(positionOf(skeleton, "leftUpperLeg").y(), 0.25);
  EXPECT_LT(positionOf(skeleton, "leftFoot").y(), 0.1);
  EXPECT_LT(std::abs(positionOf(skeleton, "leftFoot").x() - 0.09), 0.06);
  EXPECT_LT(positionOf(skeleton, "leftUpperArm").y(), 0.42);
  EXPECT_GT(positionOf(skeleton, "leftHand").x(), 0.25);
  EXPECT_LT(std::abs(positionOf(skeleton, "leftHand").y() - 0.34), 0.04);
  EXPECT_GT(positionOf(skeleton, "head").y(), 0.4);
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
    EXPECT_LT((left.col(1) - right.col(1).cwiseProduct(turn)).norm(), 1e-6) << name;
    EXPECT_LT((left.col(2) - right.col(2).cwiseProduct(turn)).norm(), 1e-6) << name;
    EXPECT_NEAR(left.determinant(), 1, 1e-9);
  }
  EXPECT_GT(globals[skeleton.find("leftUpperArm").value()].linear()(2, 2), 0.99);  // +Z to the front
}

TEST(TemplateRigger, FollowsAModelThatStandsAnotherWay) {
  const testing::CapsulePerson body = testing::capsulePerson();
  Mat3 turn;  // +Z up, facing -Y: as modelling programs have it
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  TriMesh lying = body.mesh;
  for (Vec3f& p : lying.positions) p = turn.cast<float>() * p;
  EXPECT_LT((positionOf(rig(lying, person()).skeleton, "leftHand") - turn * body.hand).norm(), 0.08);

  const Mat3 about = Eigen::AngleAxisd(EIGEN_PI, Vec3::UnitY()).toRotationMatrix();
  TriMesh away = body.mesh;
  for (Vec3f& p : away.positions) p = about.cast<float>() * p;
  RigOptions options = person();
  options.up = Vec3::UnitY();
  options.front = -Vec3::UnitZ();
  EXPECT_LT((positionOf(rig(away, options).skeleton, "leftHand") - about * body.hand).norm(), 0.08);
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

// A user's skeleton: trunk and arms; the left collar as well as the right one is `collar` to the left.
Skeleton ownSkeleton(double collar, bool crossed) {
  Skeleton skeleton;
  const auto add = [&](const std::string& name, std::optional<Index> parent, const Vec3& from) {
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.rest.translation = from;
    skeleton.joints.push_back(joint);
    return skeleton.jointCount() - 1;
  };
  const Index root = add("root", std::nullopt, {0, 1, 0}), neck = add("neck", root, {0, 0.45, 0});
  add("top", neck, {0, 0.3, 0});
  const Index left = add("LeftCollar", neck, {collar, 0.05, 0}), right = add("RightCollar", neck, {-collar, 0.05, 0});
  add("LeftHand", crossed ? right : left, {0.7, -0.1, 0});
  add("RightHand", crossed ? left : right, {-0.7, -0.1, 0});
  return skeleton;
}

TEST(TemplateRigger, TakesSkeletonsWhoseSidesMeetOrCross) {
  for (const double collar : {0.0, 0.1}) {
    for (const bool crossed : {false, true}) {
      RigOptions options = person();
      options.templateName = "mine";
      options.templateSkeleton = ownSkeleton(collar, crossed);
      const Skeleton skeleton = rig(testing::capsulePerson().mesh, options).skeleton;
      checkSkeleton(skeleton);
      EXPECT_GT(positionOf(skeleton, "LeftHand").x(), 0.1) << collar << crossed;
      EXPECT_LT(positionOf(skeleton, "RightHand").x(), -0.1) << collar << crossed;
      EXPECT_LT(std::abs(positionOf(skeleton, "neck").x()), 0.03) << collar << crossed;
    }
  }
}

TEST(TemplateRigger, SaysWhereAPersonHasNoPlace) {
  const AutoRig result = rig(ball(), person());
  EXPECT_LT(result.matches[0].confidence, 0.4);
  EXPECT_TRUE(warnsOf(result, "low-confidence"));
  checkSkeleton(result.skeleton);
}

// Handles then, as many as suit it, and what is likeliest is told; who asks for a template gets it.
TEST(TemplateRigger, AbstainsWhereNoTemplateIsLikely) {
  RigOptions options;
  const AutoRig result = rig(ball(), options);
  EXPECT_TRUE(result.isAbstained);
  EXPECT_TRUE(warnsOf(result, "no-template"));
  EXPECT_EQ(result.matches.size(), templateSkeletons().size());
  EXPECT_LT(result.matches[0].confidence, kLikelyTemplate);
  ASSERT_FALSE(result.suggestions.empty());
  EXPECT_EQ(result.skeleton.jointCount(), result.suggestions[0].handles);
  options.mayAbstain = false;
  EXPECT_FALSE(rig(ball(), options).isAbstained);
  EXPECT_FALSE(rig(ball(), person()).isAbstained);
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
  EXPECT_LT(upper.matches[0].confidence, 0.4);
  EXPECT_EQ(whereOf(upper, "no-place"), "leftUpperLeg to leftToes, rightUpperLeg to rightToes");
  const AutoRig armless = riggedPartOfAPerson([](const Vec3f& p) { return std::abs(p.x()) < 0.15f; });
  EXPECT_LT(armless.matches[0].confidence, 0.4);
  EXPECT_EQ(whereOf(armless, "no-place"), "leftShoulder to leftHand, rightShoulder to rightHand");

  // Limbs without a match come first, a pair once.
  ASSERT_EQ(upper.doubts.size(), 3u);
  EXPECT_TRUE(upper.doubts[0] == "leftToes" || upper.doubts[0] == "rightToes") << upper.doubts[0];
  ASSERT_EQ(armless.doubts.size(), 3u);
  EXPECT_TRUE(armless.doubts[0] == "leftHand" || armless.doubts[0] == "rightHand") << armless.doubts[0];
  EXPECT_TRUE(riggedPerson().doubts.empty());
}

TEST(TemplateRigger, WhatIsPinnedIsNoLongerInDoubt) {
  RigOptions options = person();
  const AutoRig first = rig(ball(), options);
  ASSERT_FALSE(first.doubts.empty());
  options.pins.push_back({first.doubts[0], {0, 0.9, 0}});
  for (const std::string& doubt : rig(ball(), options).doubts) EXPECT_NE(doubt, first.doubts[0]);
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

TEST(TemplateRigger, SaysWhereTheHeadIsCutOff) {
  EXPECT_EQ(whereOf(riggedPartOfAPerson([](const Vec3f&) { return true; }), "no-place"), "");
  const AutoRig headless = riggedPartOfAPerson([](const Vec3f& p) { return p.y() < 0.85f; });
  EXPECT_LT(headless.matches[0].confidence, 0.75);
  EXPECT_EQ(whereOf(headless, "no-place"), "neck to head");
}

// A person fits into its seat, and leaves all else as it is.
TEST(TemplateRigger, AChairIsNoPerson) {
  TriMesh chair;
  for (const double x : {-0.2, -0.1, 0.0, 0.1, 0.2}) testing::addCapsule(chair, {x, 0.45, -0.2}, {x, 0.45, 0.2}, 0.06);
  for (const double x : {-0.22, 0.22}) {
    testing::addCapsule(chair, {x, 0.03, 0.2}, {x, 0.45, 0.2}, 0.03);
    testing::addCapsule(chair, {x, 0.03, -0.2}, {x, 0.97, -0.2}, 0.03);
  }
  testing::addCapsule(chair, {-0.22, 0.9, -0.2}, {0.22, 0.9, -0.2}, 0.03);
  const AutoRig result = rig(chair, person());
  EXPECT_LT(result.matches[0].confidence, 0.4);
  EXPECT_TRUE(warnsOf(result, "low-confidence"));
}

TEST(TemplateRigger, FindsTheTemplate) {
  RigOptions options;
  const AutoRig result = rig(testing::capsulePerson().mesh, options);
  EXPECT_EQ(result.matches[0].name, "humanoid");
  for (const TemplateMatch& match : result.matches) EXPECT_NE(match.name, "quadruped") << "its shape is upright";
  for (std::size_t i = 1; i < result.matches.size(); ++i) {
    EXPECT_LE(result.matches[i].confidence, result.matches[i - 1].confidence);
  }
  options.templateName = "centaur";
  EXPECT_THROW(rig(ball(), options), Error);
}

AutoRig autoRigged(const TriMesh& mesh, RigOptions options = {}) {
  return rig(prepareMesh(mesh.positions, mesh.triangles).mesh, options);
}

// What no template was made for gets a skeleton along its curves.
TEST(TemplateRigger, TakesTheKindThatTheShapeTells) {
  const std::pair<TriMesh, const char*> cases[] = {
      {testing::capsuleTheropod(), "dinosaur"}, {testing::capsuleSpider(3), "insect"},
      {testing::capsuleSpider(4), "spider"},    {testing::capsuleFish(), "fish"},
      {testing::capsuleSnake(), "serpent"},     {testing::capsuleHound(), "quadruped"}};
  for (const auto& [mesh, name] : cases) {
    const AutoRig result = autoRigged(mesh);
    EXPECT_FALSE(result.isAbstained) << name;
    EXPECT_EQ(result.matches[0].name, name);
    EXPECT_GT(result.matches[0].confidence, 0.6) << name;
    checkSkeleton(result.skeleton);
  }
}

// Whoever brings a skeleton gets that one, whatever the shape tells.
TEST(TemplateRigger, AUsersSkeletonIsNeverReplaced) {
  Skeleton own;
  for (const auto& [name, y] : {std::pair{"base", 0.1}, {"middle", 0.4}, {"top", 0.5}}) {
    Joint joint;
    joint.name = name;
    if (!own.joints.empty()) joint.parent = own.jointCount() - 1;
    joint.rest.translation = Vec3(0, y, 0);
    own.joints.push_back(joint);
  }
  RigOptions options;
  options.templateSkeleton = own;
  const AutoRig result = autoRigged(testing::capsuleSpider(4), options);
  ASSERT_EQ(result.skeleton.jointCount(), own.jointCount());
  EXPECT_EQ(result.skeleton.joints[1].name, "middle");
}

TEST(TemplateRigger, PinsHoldWhatFollowsTheCurves) {
  RigOptions options;
  options.templateName = "serpent";
  const Vec3 pinned(0, 0.25, 0.3);
  options.pins = {{"chest", pinned}};
  const AutoRig result = autoRigged(testing::capsuleSnake(), options);
  EXPECT_LT((positionOf(result.skeleton, "chest") - pinned).norm(), 1e-9);
  options.pins = {{"leftPaw", pinned}};
  EXPECT_THROW(autoRigged(testing::capsuleSnake(), options), Error);
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
  EXPECT_EQ(fingered.matches[1].name, "humanoid");
  EXPECT_GT(fingered.matches[0].confidence, 0.9);
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
