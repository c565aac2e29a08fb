// Templates fitted into bodies that do not stand as templates do.
#include <initializer_list>
#include <string>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

constexpr double kNearPosed = 0.14;  // heights from where a body of capsules has a joint

// A person who sits: 1 high from the soles to the top of the head, the forearms on the thighs.
struct SeatedPerson {
  TriMesh mesh;
  Vec3 shoulder = {0.14, 0.66, -0.2}, elbow = {0.2, 0.46, -0.14}, hand = {0.13, 0.42, 0.06};  // of the left
  Vec3 hip = {0.08, 0.36, -0.2}, knee = {0.12, 0.36, 0.1}, ankle = {0.12, 0.05, 0.1};
  Vec3 head = {0, 0.84, -0.19};
};

SeatedPerson seatedPerson() {
  SeatedPerson person;
  TriMesh& mesh = person.mesh;
  testing::addCapsule(mesh, {0, 0.38, -0.2}, {0, 0.62, -0.2}, 0.11);
  testing::addCapsule(mesh, {0, 0.66, -0.2}, {0, 0.8, -0.2}, 0.04);
  testing::addCapsule(mesh, {0, 0.86, -0.19}, {0, 0.9, -0.19}, 0.1);
  for (const double s : {1.0, -1.0}) {
    const auto sided = [&](const Vec3& p) { return Vec3(s * p.x(), p.y(), p.z()); };
    testing::addCapsule(mesh, sided({0.04, 0.66, -0.2}), sided(person.shoulder), 0.05);
    testing::addCapsule(mesh, sided(person.shoulder), sided(person.elbow), 0.04);
    testing::addCapsule(mesh, sided(person.elbow), sided(person.hand), 0.035);
    testing::addCapsule(mesh, sided(person.hand), sided(person.hand + Vec3(0, -0.02, 0.08)), 0.03);
    testing::addCapsule(mesh, sided(person.hip), sided(person.knee), 0.06);
    testing::addCapsule(mesh, sided(person.knee), sided(person.ankle), 0.045);
    testing::addCapsule(mesh, sided({0.12, 0.035, 0.1}), sided({0.12, 0.03, 0.22}), 0.035);
  }
  return person;
}

Vec3 mirrored(const Vec3& position) {
  return {-position.x(), position.y(), position.z()};
}

// A person in mid-stride who points forward: 1 high, facing +Z.
struct Strider {
  TriMesh mesh;
  Vec3 leftElbow = {0.12, 0.78, 0.14}, leftHand = {0.12, 0.8, 0.28};
  Vec3 rightElbow = {-0.16, 0.66, -0.06}, rightHand = {-0.18, 0.53, -0.02};
  Vec3 leftKnee = {0.07, 0.3, 0.14}, leftAnkle = {0.07, 0.06, 0.16};
  Vec3 rightKnee = {-0.07, 0.28, -0.06}, rightAnkle = {-0.07, 0.09, -0.22};
};

Strider strider() {
  Strider body;
  TriMesh& mesh = body.mesh;
  const auto chain = [&](std::initializer_list<Vec3> positions, double radius) {
    for (auto a = positions.begin(), b = a + 1; b != positions.end(); ++a, ++b)
      testing::addCapsule(mesh, *a, *b, radius);
  };
  testing::addCapsule(mesh, {0, 0.55, 0}, {0, 0.72, 0}, 0.085);
  testing::addCapsule(mesh, {0, 0.78, 0}, {0, 0.86, 0}, 0.03);
  testing::addCapsule(mesh, {0, 0.9, 0.01}, {0, 0.93, 0.01}, 0.07);
  testing::addCapsule(mesh, {-0.1, 0.77, 0}, {0.1, 0.77, 0}, 0.035);
  chain({{0.1, 0.77, 0}, body.leftElbow, body.leftHand, body.leftHand + Vec3(0, 0.01, 0.09)}, 0.028);
  chain({{-0.1, 0.77, 0}, body.rightElbow, body.rightHand, body.rightHand + Vec3(0, -0.08, 0.03)}, 0.028);
  chain({{0.06, 0.5, 0}, body.leftKnee, body.leftAnkle}, 0.042);
  chain({{-0.06, 0.5, 0}, body.rightKnee, body.rightAnkle}, 0.042);
  chain({body.leftAnkle - Vec3(0, 0.03, 0.02), body.leftAnkle + Vec3(0, -0.03, 0.1)}, 0.03);
  chain({body.rightAnkle - Vec3(0, 0.02, 0.01), body.rightAnkle + Vec3(0, -0.06, 0.09)}, 0.03);
  return body;
}

}  // namespace

TEST(PosedBodies, HeadHandsAndFeetTellTheRestOfASeatedOne) {
  const SeatedPerson person = seatedPerson();
  RigOptions options;
  options.templateName = "humanoid";
  options.up = Vec3::UnitY();
  options.front = Vec3::UnitZ();
  options.pins = {{"head", person.head},
                  {"leftHand", person.hand},
                  {"rightHand", mirrored(person.hand)},
                  {"leftFoot", person.ankle},
                  {"rightFoot", mirrored(person.ankle)}};
  Progress progress;
  const Skeleton skeleton = rigWithTemplate(person.mesh, options, progress).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  const auto off = [&](const std::string& joint, const Vec3& position) {
    return (globals[skeleton.find(joint).value()].translation() - position).norm();
  };
  for (const bool right : {false, true}) {
    const std::string side = right ? "right" : "left";
    const auto sided = [&](const Vec3& position) { return right ? mirrored(position) : position; };
    EXPECT_LT(off(side + "UpperArm", sided(person.shoulder)), kNearPosed);
    EXPECT_LT(off(side + "LowerArm", sided(person.elbow)), kNearPosed);
    EXPECT_LT(off(side + "UpperLeg", sided(person.hip)), kNearPosed);
    EXPECT_LT(off(side + "LowerLeg", sided(person.knee)), kNearPosed);
  }
}

TEST(PosedBodies, LimbsMaySwing) {
  const Strider body = strider();
  RigOptions options;
  options.templateName = "humanoid";
  Progress progress;
  const AutoRig rig = rigWithTemplate(body.mesh, options, progress);
  EXPECT_GT(rig.matches.front().confidence, kLikelyTemplate);
  const std::vector<Affine> globals = restGlobals(rig.skeleton);
  const auto off = [&](const char* joint, const Vec3& position) {
    return (globals[rig.skeleton.find(joint).value()].translation() - position).norm();
  };
  EXPECT_LT(off("leftLowerArm", body.leftElbow), kNearPosed);
  EXPECT_LT(off("leftHand", body.leftHand), kNearPosed);
  EXPECT_LT(off("rightLowerArm", body.rightElbow), kNearPosed);
  EXPECT_LT(off("rightHand", body.rightHand), kNearPosed);
  EXPECT_LT(off("leftLowerLeg", body.leftKnee), kNearPosed);
  EXPECT_LT(off("leftFoot", body.leftAnkle), kNearPosed);
  EXPECT_LT(off("rightLowerLeg", body.rightKnee), kNearPosed);
  EXPECT_LT(off("rightFoot", body.rightAnkle), kNearPosed);
}

}  // namespace limber
