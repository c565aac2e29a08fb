#include "limber/rigging/pose_search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/rigging/template_rigger.h"
#include "limber/rigging/testing/capsule_person.h"
#include "limber/rigging/testing/measured_person.h"

namespace limber {

namespace {

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
  const auto chain = [&](std::initializer_list<Vec3> places, double radius) {
    for (auto a = places.begin(), b = a + 1; b != places.end(); ++a, ++b) testing::addCapsule(mesh, *a, *b, radius);
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

TEST(PoseSearch, LeavesWhatStandsAlone) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  std::vector<TemplateFit> fits =
      fitVariants({{skeleton, 0}}, person.body, person.frame, TemplatePins(skeleton.jointCount()), {});
  const std::vector<Vec3> before = fits.front().embedding.places;
  searchPose(person.body, fits.front());
  EXPECT_FALSE(fits.front().skeleton.bent());
  EXPECT_EQ(fits.front().embedding.places, before);
}

TEST(PoseSearch, FindsLimbsThatSwing) {
  const Strider body = strider();
  RigOptions options;
  options.templateName = "humanoid";
  Progress progress;
  const AutoRig rig = rigWithTemplate(body.mesh, options, progress);
  EXPECT_GT(rig.matches.front().confidence, 0.6);
  const std::vector<Affine> globals = restGlobals(rig.skeleton);
  const auto off = [&](const char* joint, const Vec3& place) {
    return (globals[rig.skeleton.find(joint).value()].translation() - place).norm();
  };
  EXPECT_LT(off("leftLowerArm", body.leftElbow), 0.07);
  EXPECT_LT(off("leftHand", body.leftHand), 0.07);
  EXPECT_LT(off("rightLowerArm", body.rightElbow), 0.07);
  EXPECT_LT(off("rightHand", body.rightHand), 0.07);
  EXPECT_LT(off("leftLowerLeg", body.leftKnee), 0.07);
  EXPECT_LT(off("leftFoot", body.leftAnkle), 0.07);
  EXPECT_LT(off("rightLowerLeg", body.rightKnee), 0.07);
  EXPECT_LT(off("rightFoot", body.rightAnkle), 0.07);
}

}  // namespace limber
