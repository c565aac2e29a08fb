#include "limber/rigging/body/feet_direction.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

double forwardOf(const TriMesh& mesh, const BodyVolume& body, const Vec3& front) {
  const AnatomicalFrame frame = frameAlong(mesh, body, Vec3::UnitY(), front);
  const Vec3 feet[] = {frame.toBody({0.09, 0.045, 0}), frame.toBody({-0.09, 0.045, 0})};
  return feetForward(body, frame, feet);
}

}  // namespace

TEST(FeetDirection, TellsFrontFromBack) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  EXPECT_GT(forwardOf(person.shape.mesh, person.body, Vec3::UnitZ()), 0.3);
  EXPECT_LT(forwardOf(person.shape.mesh, person.body, -Vec3::UnitZ()), -0.3);
}

// Both legs lean far: the soles are not below the shins.
TEST(FeetDirection, IsUnknownOfASteppingPerson) {
  TriMesh mesh;
  testing::addCapsule(mesh, {0, 0.5, 0}, {0, 0.9, 0}, 0.1);
  for (const double x : {0.09, -0.09}) {
    testing::addCapsule(mesh, {x, 0.05, -0.2}, {x, 0.5, 0}, 0.04);
    testing::addCapsule(mesh, {x, 0.03, -0.21}, {x, 0.03, -0.12}, 0.03);
  }
  const BodyVolume body = measureBody(mesh);
  const AnatomicalFrame frame = frameAlong(mesh, body, Vec3::UnitY(), Vec3::UnitZ());
  const Vec3 feet[] = {frame.toBody({0.09, 0.045, -0.2}), frame.toBody({-0.09, 0.045, -0.2})};
  EXPECT_EQ(feetForward(body, frame, feet), 0);
}

TEST(FeetDirection, IsUnknownOfPegsAndPlinths) {
  TriMesh pegs;
  testing::addCapsule(pegs, {0, 0.5, 0}, {0, 0.9, 0}, 0.1);
  for (const double x : {0.09, -0.09}) testing::addCapsule(pegs, {x, 0.05, 0}, {x, 0.5, 0}, 0.05);
  EXPECT_NEAR(forwardOf(pegs, measureBody(pegs), Vec3::UnitZ()), 0, 0.05);

  TriMesh statue = testing::capsulePerson().mesh;
  for (double x = -0.3; x <= 0.3; x += 0.04) testing::addCapsule(statue, {x, 0.025, -0.15}, {x, 0.025, 0.35}, 0.025);
  EXPECT_EQ(forwardOf(statue, measureBody(statue), Vec3::UnitZ()), 0);
}

}  // namespace limber
