#include "limber/rigging/body/body_curves.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "limber/rigging/body/testing/capsule_animal.h"

namespace limber {
namespace {

std::vector<BodyCurve> curvesOf(const TriMesh& mesh) {
  const testing::MeasuredAnimal animal = testing::measured(mesh);
  return bodyCurves(animal.body, animal.frames.front());
}

// Limbs on the trunk.
std::vector<BodyCurve> pairsOf(const std::vector<BodyCurve>& curves) {
  std::vector<BodyCurve> pairs;
  for (const BodyCurve& curve : curves) {
    if (curve.isPaired && curve.carrier == std::size_t{0} && curve.length > 0.1) pairs.push_back(curve);
  }
  return pairs;
}

}  // namespace

TEST(BodyCurves, RunFromEndToEndAndDownTheLegs) {
  const std::vector<BodyCurve> curves = curvesOf(testing::capsuleHound());
  const BodyCurve& trunk = curves.front();
  EXPECT_FALSE(trunk.carrier || trunk.isPaired);
  EXPECT_GT(trunk.length, 1.0);
  for (const BodyCurve::Point& point : trunk.points) EXPECT_EQ(point.position.x(), 0);
  EXPECT_GT(std::abs(trunk.points.front().position.z() - trunk.end().z()), 0.9) << "from the tail to the nose";
  const std::vector<BodyCurve> legs = pairsOf(curves);
  ASSERT_EQ(legs.size(), 2u);
  for (const BodyCurve& leg : legs) {
    EXPECT_LT(leg.end().y(), 0.06);
    EXPECT_GT(leg.end().x(), 0.04) << "the left one";
    EXPECT_NEAR(leg.flatness(), 1, 0.4);
    EXPECT_NEAR(leg.meanRadius(), 0.035, 0.015);
  }
}

TEST(BodyCurves, ASnakeIsOneCurve) {
  const std::vector<BodyCurve> curves = curvesOf(testing::capsuleSnake());
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_NEAR(curves[0].length, 1.2, 0.15);
}

TEST(BodyCurves, CountEachPairOfLegs) {
  for (const int pairs : {3, 4, 5}) {
    EXPECT_EQ(pairsOf(curvesOf(testing::capsuleSpider(pairs))).size(), static_cast<std::size_t>(pairs));
  }
}

TEST(BodyCurves, SeeThatFinsAreFlat) {
  const std::vector<BodyCurve> fins = pairsOf(curvesOf(testing::capsuleFish()));
  ASSERT_EQ(fins.size(), 1u);
  EXPECT_GT(fins[0].flatness(), 2.4);
}

// What one side alone holds is no part of the body.
TEST(BodyCurves, LeaveOutWhatOneSideHolds) {
  TriMesh armed = testing::capsuleHound();
  testing::addCapsule(armed, {0.08, 0.44, 0}, {0.16, 0.46, 0}, 0.025);
  const testing::MeasuredAnimal animal = testing::measured(armed);
  for (const Vec3& front : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {  // it may be on either side
    const AnatomicalFrame frame = frameAlong(animal.mesh, animal.body, Vec3::UnitY(), front);
    EXPECT_EQ(pairsOf(bodyCurves(animal.body, frame)).size(), 2u);
  }
}

}  // namespace limber
