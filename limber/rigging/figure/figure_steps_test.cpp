#include "limber/rigging/figure/figure_steps.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

namespace {

// Unit vectors stay unit, axes stay right-handed and square.
void expectSound(const Figure& figure) {
  EXPECT_NEAR(figure.neck.norm(), 1, 1e-9);
  for (const Mat3& axes : {figure.chest, figure.pelvis}) {
    EXPECT_LT((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-9);
    EXPECT_NEAR(axes.determinant(), 1, 1e-9);
  }
  for (const FigureLimb& bones : figure.limbs) {
    for (const Vec3& displacement : {bones.upper, bones.lower, bones.end}) EXPECT_NEAR(displacement.norm(), 1, 1e-9);
    EXPECT_GT(bones.upperScale, 0.5);
    EXPECT_LT(bones.upperScale, 1.6);
    EXPECT_LT(bones.shift.norm(), 0.06);
  }
  EXPECT_GT(figure.stature, 0);
  EXPECT_GT(figure.headRadius, 0);
}

}  // namespace

TEST(FigureSteps, LeaveAFigureSound) {
  Figure figure = testing::crouchingFigure();
  Random random(1);
  for (int step = 0; step < 500; ++step) {
    stepTrunk(figure, 0.3, random);
    stepLimb(figure, step % kFigureLimbs, 0.3, random);
  }
  expectSound(figure);
}

TEST(FigureSteps, OfALimbLeaveTheOthers) {
  const Figure before = testing::crouchingFigure();
  Figure figure = before;
  Random random(2);
  for (int step = 0; step < 50; ++step) stepLimb(figure, 0, 1, random);
  EXPECT_GT((figure.positions(0).ankle - before.positions(0).ankle).norm(), 1e-3);
  for (int limb = 1; limb < kFigureLimbs; ++limb) EXPECT_EQ(figure.positions(limb).tip, before.positions(limb).tip);
}

TEST(FigureSteps, OfTheTrunkMostlyLeaveHandsAndFeetWhereTheyAre) {
  const Figure before = testing::crouchingFigure();
  Random random(3);
  int stayed = 0;
  for (int step = 0; step < 200; ++step) {
    Figure figure = before;
    stepTrunk(figure, 0.3, random);
    double moved = 0;
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      moved = std::max(moved, (figure.positions(limb).middle - before.positions(limb).middle).norm());
      moved = std::max(moved, (figure.positions(limb).ankle - before.positions(limb).ankle).norm());
    }
    stayed += moved < 1e-9;
  }
  EXPECT_GT(stayed, 100);
}

TEST(FigureSteps, GetSmallerWhereTheyFailAndEnd) {
  StepSize size(2, 0.5);
  EXPECT_TRUE(size.failed());
  size.succeeded();
  EXPECT_TRUE(size.failed());
  EXPECT_TRUE(size.failed());
  EXPECT_EQ(size.value(), 1);
  EXPECT_TRUE(size.failed());
  EXPECT_EQ(size.value(), 0.5);
  int more = 0;
  while (size.failed()) ++more;
  EXPECT_EQ(more, 5) << "0.25 is tried, 0.125 is not";
}

TEST(FigureSteps, OneWhoTurnsAroundHasItsHandsWhereTheyWere) {
  const Figure before = testing::standingFigure(), after = turnedAround(before);
  expectSound(after);
  EXPECT_EQ(Vec3(after.pelvis.col(2)), -Vec3::UnitZ());
  EXPECT_LT((after.positions(0).ankle - before.positions(1).ankle).norm(), 1e-9);
  EXPECT_LT((after.positions(3).ankle - before.positions(2).ankle).norm(), 1e-9);
  EXPECT_LT(after.positions(2).tip.z(), 0) << "toes point where it looks";
  for (int limb = 0; limb < kFigureLimbs; ++limb) EXPECT_TRUE(limbAllowed(after, limb));
  Figure bent = before;
  bent.limbs[2].upper = Vec3(0.05, -1, 0.3).normalized();
  bent.limbs[2].lower = Vec3(0.05, -1, -0.3).normalized();
  ASSERT_TRUE(limbAllowed(bent, 2));
  EXPECT_TRUE(limbAllowed(turnedAround(bent), 3)) << "straight, as the knee would bend forward";
}

}  // namespace limber
