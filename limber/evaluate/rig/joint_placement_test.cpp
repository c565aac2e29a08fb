// Joints in tubes and balls, where chords have closed forms.
#include "limber/evaluate/rig/joint_placement.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

constexpr double kTubeRadius = 0.1;  // of the tube

// A chain of three joints along the tube, which lies along x, moved off its axis.
SkinnedModel chainInTube(const Vec3& off) {
  SkinnedModel model;
  model.mesh = limber::testing::tube(256, 9, true);
  for (Index j = 0; j < 3; ++j) {
    Joint joint;
    joint.name = std::string(1, static_cast<char>('a' + j));
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = j == 0 ? Vec3(Vec3(-0.3, 0, 0) + off) : Vec3(0.3, 0, 0);
    model.skeleton.joints.push_back(joint);
  }
  return model;
}

// Of a circle's chord through a point e off the middle, the parts are r' -+ e cos a with r' = sqrt(r^2 - e^2 sin^2 a).
double chordsOff(double e) {
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double a = kPi * i / 8;
    sum += e * std::abs(std::cos(a)) / std::sqrt(kTubeRadius * kTubeRadius - e * e * std::sin(a) * std::sin(a));
  }
  return sum / 8;
}

TEST(JointPlacement, OnTheAxisIsCentered) {
  const JointPlacement placement = measureJointPlacement(chainInTube(Vec3::Zero()), {true, true, true});
  EXPECT_EQ(placement.inside, 1);
  EXPECT_NEAR(placement.offCenter, 0, 1e-3);
}

TEST(JointPlacement, OffTheAxisIsTheClosedForm) {
  for (const double e : {0.02, 0.05, 0.08}) {
    // The chords lie at multiples of a 16th of a turn from the direction in which the joints are off.
    const JointPlacement placement = measureJointPlacement(chainInTube({0, 0, e}), {true, true, true});
    EXPECT_EQ(placement.inside, 1);
    EXPECT_NEAR(placement.offCenter, chordsOff(e), 0.01) << e;
  }
}

TEST(JointPlacement, OutsideIsAsFarOffAsCanBe) {
  const JointPlacement placement = measureJointPlacement(chainInTube({0, 0, 0.3}), {true, true, true});
  EXPECT_EQ(placement.inside, 0);
  EXPECT_EQ(placement.offCenter, 1);
}

TEST(JointPlacement, OnlyJointsThatCountDo) {
  SkinnedModel model = chainInTube(Vec3::Zero());
  model.skeleton.joints[2].rest.translation = Vec3(3, 0, 0);  // beyond the end
  EXPECT_NEAR(measureJointPlacement(model, {true, true, true}).inside, 2.0 / 3, 1e-12);
  EXPECT_EQ(measureJointPlacement(model, {true, true, false}).inside, 1);
}

TEST(JointPlacement, AJointAloneHasNoChord) {
  SkinnedModel model = chainInTube({0, 0, 0.05});
  model.skeleton.joints.resize(1);
  const JointPlacement placement = measureJointPlacement(model, {true});
  EXPECT_EQ(placement.inside, 1);
  EXPECT_EQ(placement.offCenter, 0);
}

class JointPlacementOverTheCatalogue : public ::testing::TestWithParam<limber::testing::NamedMesh> {};

TEST_P(JointPlacementOverTheCatalogue, IsAShare) {
  SkinnedModel model = chainInTube({0.01, 0.02, 0.03});
  model.mesh = GetParam().mesh;
  const JointPlacement placement = measureJointPlacement(model, {true, true, true});
  for (const double fraction : {placement.inside, placement.offCenter}) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, JointPlacementOverTheCatalogue, ::testing::ValuesIn(limber::testing::catalogue()),
                         limber::testing::MeshName());

}  // namespace
}  // namespace limber
