#include "limber/rigging/figure/figure.h"

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

TEST(Figure, StandsAsHighAsItSays) {
  const Figure figure = testing::standingFigure();
  EXPECT_NEAR(figure.head.y() + figure.headRadius, 1, 0.02);
  EXPECT_NEAR(figure.hips().y(), 0.53, 0.03) << "of the greater trochanter, after Drillis and Contini";
  EXPECT_NEAR(figure.socket(0).y(), 0.818, 0.03) << "of the shoulder";
  EXPECT_NEAR(figure.positions(2).ankle.y(), 0.039, 0.03) << "of the ankle";
}

TEST(Figure, HasItsLeftAtTheLeft) {
  const Figure figure = testing::standingFigure();
  for (const int limb : {0, 2}) {
    const LimbPositions left = figure.positions(limb), right = figure.positions(limb + 1);
    EXPECT_GT(left.root.x(), 0);
    EXPECT_LT((left.tip.cwiseProduct(Vec3(-1, 1, 1)) - right.tip).norm(), 1e-12);
  }
}

TEST(Figure, ShouldersGiveWayAndBonesStretch) {
  Figure figure = testing::standingFigure();
  const LimbPositions before = figure.positions(0);
  figure.limbs[0].shift = {0.01, 0, 0};
  figure.limbs[0].upperScale = 1.1;
  const LimbPositions after = figure.positions(0);
  EXPECT_LT((after.root - before.root - Vec3(0.01, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR((after.middle - after.root).norm(), 1.1 * proportions::kUpperArm, 1e-12);
}

TEST(Figure, PeopleBendElbowsForwardAndKneesBack) {
  Figure figure = testing::standingFigure();
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    ASSERT_TRUE(limbAllowed(figure, limb));
    const double forward = isLeg(limb) ? -1 : 1;
    FigureLimb& bones = figure.limbs[limb];
    bones.lower = Vec3(0, -1, forward).normalized();
    if (isLeg(limb)) bones.end = Vec3(0, -1, 0.5).normalized();
    EXPECT_TRUE(limbAllowed(figure, limb)) << limb;
    bones.lower = Vec3(0, -1, -forward).normalized();
    EXPECT_FALSE(limbAllowed(figure, limb)) << limb;
  }
}

TEST(Figure, NoThighPointsStraightBackAndNoFootDoes) {
  Figure figure = testing::standingFigure();
  EXPECT_FALSE(upperAllowed(figure.pelvis, 2, -Vec3::UnitZ()));
  EXPECT_TRUE(upperAllowed(figure.pelvis, 2, Vec3::UnitZ()));
  EXPECT_FALSE(upperAllowed(figure.chest, 0, -Vec3::UnitX())) << "across the chest to the other side";
  figure.limbs[2].end = Vec3(0, -0.3, -1).normalized();
  EXPECT_FALSE(limbAllowed(figure, 2));
}

TEST(Figure, ToesPointWhereTheKneeDoes) {
  const Figure figure = testing::crouchingFigure();
  EXPECT_GT(toesForward(figure, 2).normalized().z(), 0.9) << "of the leg that stands";
  EXPECT_LT(toesForward(figure, 3).normalized().y(), -0.8) << "of the leg that kneels";
}

}  // namespace limber
