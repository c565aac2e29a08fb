#include "limber/rigging/figure/limb_overlap.h"

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

namespace {

double shared(const Figure& figure, int a, int b) {
  return limbOverlap(spaceOf(figure, a), spaceOf(figure, b));
}

}  // namespace

TEST(LimbOverlap, IsNoneOfLimbsThatAreApart) {
  const Figure figure = testing::standingFigure();
  for (int a = 0; a < kFigureLimbs; ++a) {
    for (int b = 0; b < kFigureLimbs; ++b) EXPECT_EQ(a != b && shared(figure, a, b) > 0, false) << a << " " << b;
  }
}

TEST(LimbOverlap, GrowsAsLimbsComeNear) {
  Figure figure = testing::standingFigure();
  const FigureLimb straight = figure.limbs[3];
  const Vec3 toOther = (figure.positions(2).middle - figure.socket(3)).normalized();
  double before = 0;
  for (const double part : {0.7, 0.85, 1.0}) {
    figure.limbs[3].upper = ((1 - part) * straight.upper + part * toOther).normalized();
    const double now = shared(figure, 2, 3);
    EXPECT_GT(now, before);
    EXPECT_EQ(now, shared(figure, 3, 2));
    before = now;
  }
  EXPECT_GT(before, 2);
}

TEST(LimbOverlap, OfALimbWithItselfIsAllBeyondItsRoot) {
  const LimbSpace space = spaceOf(testing::crouchingFigure(), 3);
  EXPECT_NEAR(limbOverlap(space, space), 2.0 * static_cast<double>(space.samples.size()), 1e-9);
}

TEST(LimbOverlap, TheBallHoldsTheLimb) {
  const Figure figure = testing::crouchingFigure();
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    const LimbSpace space = spaceOf(figure, limb);
    for (const LimbSpace::Sample& sample : space.samples) {
      EXPECT_LE((sample.at - space.middle).norm() + sample.thick, space.reach + 1e-12);
    }
    for (const LimbSpace::Bone& bone : space.bones) {
      for (const Vec3& end : {bone.from, Vec3(bone.from + bone.direction)}) {
        EXPECT_LE((end - space.middle).norm() + bone.thick, space.reach + 1e-12);
      }
    }
  }
}

}  // namespace limber
