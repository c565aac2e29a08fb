#include "limber/rigging/body/leg_finder.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

const std::vector<Vec3>& legPositions() {
  static const std::vector<Vec3> positions = [] {
    const testing::MeasuredPerson& person = testing::measuredPerson();
    std::vector<Vec3> left = {person.frame.toBody(person.shape.hip), person.frame.toBody(person.shape.knee),
                              person.frame.toBody(person.shape.ankle)};
    std::vector<Vec3> all = left;
    for (const Vec3& position : left) all.push_back(position.cwiseProduct(Vec3(-1, 1, 1)));
    return all;
  }();
  return positions;
}

}  // namespace

TEST(LegFinder, FollowsLegsUpToWhereTheyPart) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  LegFinder finder(person.body, person.frame, legPositions(), {0, 1, 2}, {3, 4, 5});
  ASSERT_TRUE(finder.findParting());
  EXPECT_TRUE(finder.known());
  EXPECT_GT(finder.parting(), legPositions()[1].y());
  EXPECT_LT(finder.parting(), legPositions()[0].y() + 0.03);
  EXPECT_NEAR(finder.halfWidth(0), finder.halfWidth(1), 0.01);
  EXPECT_NEAR(finder.halfDepth(0, 0.16), 0.038, 0.01);
  EXPECT_LT((finder.middle(0, legPositions()[1].y()) - legPositions()[1]).norm(), 0.02);
  // Above where they part a leg goes straight on.
  EXPECT_NEAR(finder.middle(1, 0.8).x(), finder.middle(1, finder.parting()).x(), 1e-6);
}

TEST(LegFinder, SeesNoLegsInOneColumn) {
  TriMesh column;
  testing::addCapsule(column, {0, 0.1, 0}, {0, 0.9, 0}, 0.1);
  const BodyVolume body = measureBody(column);
  const AnatomicalFrame frame = frameAlong(column, body, Vec3::UnitY(), Vec3::UnitZ());
  const std::vector<Vec3> positions = {{0.05, 0.5, 0},  {0.05, 0.3, 0},  {0.05, 0.1, 0},
                                       {-0.05, 0.5, 0}, {-0.05, 0.3, 0}, {-0.05, 0.1, 0}};
  LegFinder finder(body, frame, positions, {0, 1, 2}, {3, 4, 5});
  EXPECT_FALSE(finder.findParting());
  EXPECT_FALSE(finder.known());
}

}  // namespace limber
