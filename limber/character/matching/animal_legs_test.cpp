#include "limber/character/matching/animal_legs.h"

#include <gtest/gtest.h>

#include <string>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

TEST(AnimalLegs, AreThoseThatComeDownToTheGround) {
  const Skeleton one = quadruped(0.5), other = quadruped(0.35);
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  for (const AnimalLeg& leg : setup.animalLegs) {
    const std::string upper = other.joints[leg.target.upper].name, stem = upper.substr(0, upper.find("One"));
    EXPECT_EQ(upper, stem + "One");
    EXPECT_EQ(leg.target.lower, other.find(stem + "Two"));
    EXPECT_EQ(leg.target.end, other.find(stem + "Three"));
    EXPECT_EQ(leg.target.toes, other.find(stem + "Four"));
    EXPECT_FALSE(leg.target.hock);
    EXPECT_EQ(one.joints[leg.source.lower].name, stem + "Two");
  }
}

// Wings ten times as long as the legs do not make it lie.
TEST(AnimalLegs, StandUnderLongWings) {
  Skeleton winged = quadruped(0.5);
  for (const double side : {1.0, -1.0}) {
    const std::string wing = side > 0 ? "leftWing" : "rightWing";
    limber::testing::addJoint(winged, wing + "One", "b1", Vec3(0.2 * side, 0, 0));
    limber::testing::addJoint(winged, wing + "Two", wing + "One", Vec3(10 * side, 0, 0));
  }
  EXPECT_EQ(RetargetSetup(winged, winged, matchSkeletons(winged, winged), {}).animalLegs.size(), 4u);
}

// Raising the neck makes no animal step further.
TEST(AnimalLegs, TheRootsWayScalesWithThem) {
  const Skeleton one = quadruped(0.5);
  Skeleton other = quadruped(0.35);
  const Index body = *other.joints[other.find("b0LeftOne").value()].parent;
  Joint head;
  head.name = "head";
  head.parent = body;
  head.rest.translation = Vec3(0, 0.3, 0.2);
  Skeleton one2 = one;
  one2.joints.push_back(head);
  head.rest.translation.y() = 1;
  other.joints.push_back(head);
  const RetargetSetup setup(one2, other, matchSkeletons(one2, other), {});
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  const auto hip = [](const Skeleton& animal) {
    const std::vector<Affine> globals = restGlobals(animal);
    double low = HUGE_VAL;
    for (const Affine& global : globals) low = std::min(low, global.translation().y());
    return globals[animal.find("b0LeftOne").value()].translation().y() - low;
  };
  EXPECT_NEAR(setup.scale, hip(other) / hip(one2), 1e-9);
}

TEST(AnimalLegs, LyingAndLeglessOnesHaveNone) {
  const Skeleton one = straightChain(8, 2);
  Skeleton snake = one;
  for (Joint& joint : snake.joints) joint.rest.translation = Vec3(0, 0, joint.rest.translation.y());
  EXPECT_TRUE(RetargetSetup(snake, snake, matchSkeletons(snake, snake), {}).animalLegs.empty());
}

}  // namespace
}  // namespace limber
