#include "limber/actions/rig/pins_outside.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"
#include "warning_kinds.h"

namespace limber {
namespace {

// Of radius 1 about (5, 0, 0), in the file's space.
PreparedMesh ball(bool isReversed = false) {
  TriMesh mesh = testing::moved(testing::icosphere(3), Vec3f::Ones(), Vec3f(5, 0, 0));
  if (isReversed) {
    for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  }
  return prepareMesh(mesh.positions, mesh.triangles);
}

Warnings warningsOf(const PreparedMesh& mesh, const std::vector<JointPin>& pins) {
  Warnings warnings;
  warnPinsOutside(mesh, pins, warnings);
  return warnings;
}

TEST(PinsOutside, SaysHowFarOutAPinIs) {
  for (const bool isReversed : {false, true}) {
    const Warnings one = warningsOf(ball(isReversed), {{"head", Vec3(5, 0.5, 0)}, {"leftHand", Vec3(6.5, 0, 0)}});
    ASSERT_EQ(testing::warningKinds(one), std::vector<std::string>{"pins-outside"});
    EXPECT_EQ(warningText(one.items()[0]), "pin leftHand is 0.5 m outside the surface");
    EXPECT_EQ(one.items()[0].where, "leftHand");
  }
}

TEST(PinsOutside, CountsThemAndNamesTheFarthest) {
  const Warnings both = warningsOf(ball(), {{"leftHand", Vec3(6.5, 0, 0)}, {"head", Vec3(5, 2, 0)}});
  ASSERT_EQ(both.items().size(), 1u);
  EXPECT_EQ(warningText(both.items()[0]), "pins are outside the surface, head by 1 m (2)");
  EXPECT_EQ(both.items()[0].where, "leftHand, head");
}

// The tolerance is 0.02 of the longest side: 0.04 here.
TEST(PinsOutside, PinsInsideAndALittleOutsideAreRight) {
  for (const Vec3& position : {Vec3(5, 0, 0), Vec3(5.99, 0, 0), Vec3(6, 0, 0), Vec3(6.03, 0, 0)}) {
    EXPECT_TRUE(warningsOf(ball(), {{"head", position}}).empty()) << position.transpose();
  }
  EXPECT_FALSE(warningsOf(ball(), {{"head", Vec3(6.05, 0, 0)}}).empty());
  EXPECT_TRUE(warningsOf(ball(), {}).empty());
}

}  // namespace
}  // namespace limber
