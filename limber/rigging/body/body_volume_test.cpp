#include "limber/rigging/body/body_volume.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/rigging/body/testing/capsule_person.h"

namespace limber {

namespace {

double nearestOf(const std::vector<Vec3>& tips, const Vec3& position) {
  double least = 1;
  for (const Vec3& tip : tips) least = std::min(least, (tip - position).norm());
  return least;
}

// Of the grid's nodes.
double insideFraction(const BodyVolume& body) {
  std::size_t inside = 0;
  for (std::size_t node = 0; node < body.distance->nodeCount(); ++node) inside += body.distance->value(node) < 0;
  return static_cast<double>(inside) / static_cast<double>(body.distance->nodeCount());
}

}  // namespace

TEST(BodyVolume, FindsTheEndsOfLimbs) {
  const testing::CapsulePerson person = testing::capsulePerson(0);
  std::vector<Vec3> tips;
  for (const LimbTip& tip : limbTips(measureBody(person.mesh))) {
    tips.push_back(tip.position);
    const bool isHand = std::abs(tip.position.x()) > person.hand.x();
    EXPECT_TRUE(!isHand || tip.reach > 3 * tip.depth) << "slender";
    EXPECT_GT(tip.depth, 0);
  }
  for (const double side : {1.0, -1.0}) {
    EXPECT_LT(nearestOf(tips, {side * (person.hand.x() + 0.1), person.hand.y(), 0}), 0.04);
    EXPECT_LT(nearestOf(tips, {side * 0.095, 0.02, 0.12}), 0.05);
  }
  EXPECT_LT(nearestOf(tips, {0, 0.99, 0}), 0.06);
}

TEST(BodyVolume, PutsSpheresInTheMiddle) {
  const testing::CapsulePerson person = testing::capsulePerson(0);
  const BodyVolume body = measureBody(person.mesh);
  ASSERT_FALSE(body.spheres.empty());
  bool arm = false, leg = false;
  for (const MedialSphere& sphere : body.spheres) {
    EXPECT_GT(sphere.radius, 0);
    arm = arm || (sphere.center - 0.5 * (person.elbow + person.hand)).norm() < 0.03;
    leg = leg || (sphere.center - 0.5 * (person.knee + person.ankle)).norm() < 0.03;
  }
  EXPECT_TRUE(arm);
  EXPECT_TRUE(leg);
}

TEST(BodyVolume, TurnsPiecesThatAreInsideOut) {
  TriMesh mesh = testing::capsulePerson().mesh;
  const BodyVolume right = measureBody(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  // A third of the pieces, and a part of one: which side that one turns to does not matter.
  const BodyVolume turned = measureBody(mesh);
  EXPECT_NEAR(insideFraction(turned), insideFraction(right), 0.2 * insideFraction(right));
}

TEST(BodyVolume, RefusesWhatHasNoInside) {
  TriMesh sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}};
  EXPECT_THROW(measureBody(sheet), Error);
}

// A cube whose bottom faces in: its copies make all winding numbers within negative, and those far above it positive.
TEST(BodyVolume, RefusesAFaceThatIsThereHundredsOfTimes) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const auto& [a, b, c, d] :
       {std::array<Index, 4>{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}) {
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
  }
  for (int copy = 0; copy < 200; ++copy) mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  EXPECT_THROW(measureBody(mesh), Error);
}

}  // namespace limber
