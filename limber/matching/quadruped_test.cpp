#include "limber/matching/quadruped.h"

#include <string>

#include <gtest/gtest.h>

#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

std::optional<Quadruped> read(const Skeleton& skeleton, const Quat& turn = Quat::Identity()) {
  std::vector<Vec3> positions;
  for (const Affine& global : restGlobals(skeleton)) positions.push_back(turn * global.translation());
  return readQuadruped(skeleton, positions);
}

TEST(Quadruped, TellsPartsAndWhereItFaces) {
  const Skeleton skeleton = quadruped(0.5);
  const auto joint = [&](const char* name) { return skeleton.find(name).value(); };
  for (const double degrees : {0.0, 90.0, 200.0}) {
    const Quat turn = limber::testing::turn(Vec3::UnitY(), degrees);
    const Quadruped animal = read(skeleton, turn).value();
    EXPECT_LT((animal.forward - turn * Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_EQ(animal.hindquarters, joint("b0"));
    EXPECT_EQ(animal.tail.front(), joint("tail1"));
    EXPECT_EQ(animal.legs[0].bones, (Quadruped::Joints{joint("b0LeftOne"), joint("b0LeftTwo")}));
    EXPECT_EQ(animal.legs[3].foot, Quadruped::Joints{joint("b1RightThree")});
    EXPECT_NEAR(animal.legs[0].along[1], 0.5, 0.01);
  }
}

TEST(Quadruped, OneThatIsReadBackToFrontIsNone) {
  Skeleton animal = quadruped(0.5);
  for (Joint& joint : animal.joints) {
    if (joint.name.ends_with("Four")) joint.rest.translation.z() *= -1;
  }
  EXPECT_FALSE(read(animal));
}

TEST(Quadruped, PeopleAreNone) {
  EXPECT_FALSE(read(practiceHumanoid()));
  EXPECT_FALSE(read(Skeleton()));
}

}  // namespace
}  // namespace limber
