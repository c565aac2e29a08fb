#include "limber/rigging/bent_template.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/rigging/template_rigger.h"
#include "limber/rigging/testing/capsule_person.h"

namespace limber {

namespace {

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

Vec3 mirrored(const Vec3& place) {
  return {-place.x(), place.y(), place.z()};
}

}  // namespace

TEST(BentTemplate, HasNoPosesWithoutPins) {
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  EXPECT_TRUE(bentToPins(skeleton, TemplatePins(skeleton.jointCount())).empty());
}

TEST(BentTemplate, BringsJointsToTheirPins) {
  for (const char* name : {"humanoid", "quadruped"}) {
    const TemplateSkeleton& skeleton = findTemplate(name);
    TemplatePins pins(skeleton.jointCount());
    const Index head = skeleton.find("head").value(), hips = skeleton.find("hips").value();
    pins[head] = Vec3(0.1, 0.6, 0.3);
    pins[hips] = Vec3(0, 0.5, -0.1);
    double nearest = 1;
    for (const TemplateVariant& variant : bentToPins(skeleton, pins)) {
      EXPECT_TRUE(variant.skeleton.bent());
      const double off = (variant.skeleton.joints[head].place - *pins[head]).norm() +
                         (variant.skeleton.joints[hips].place - *pins[hips]).norm();
      nearest = std::min(nearest, off);
    }
    EXPECT_LT(nearest, 0.01) << name;
  }
}

TEST(BentTemplate, HeadHandsAndFeetTellTheRestOfASeatedBody) {
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
  const auto off = [&](const std::string& joint, const Vec3& place) {
    return (globals[skeleton.find(joint).value()].translation() - place).norm();
  };
  for (const bool right : {false, true}) {
    const std::string side = right ? "right" : "left";
    const auto sided = [&](const Vec3& place) { return right ? mirrored(place) : place; };
    EXPECT_LT(off(side + "UpperArm", sided(person.shoulder)), 0.08);
    EXPECT_LT(off(side + "LowerArm", sided(person.elbow)), 0.08);
    EXPECT_LT(off(side + "UpperLeg", sided(person.hip)), 0.08);
    EXPECT_LT(off(side + "LowerLeg", sided(person.knee)), 0.08);
  }
}

}  // namespace limber
