#include "limber/rigging/figure/figure_match.h"

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

namespace {

struct Measured {
  Figure figure = testing::standingFigure();
  BodyVolume body = measureBody(testing::figureBody(figure));
  FigureMatch match{*body.distance};
};

const Measured& measured() {
  static const Measured person;
  return person;
}

}  // namespace

TEST(FigureMatch, DirectionsAreUnitAndEven) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& direction : evenDirections(100)) {
    EXPECT_NEAR(direction.norm(), 1, 1e-12);
    sum += direction;
  }
  EXPECT_LT(sum.norm(), 1);
}

TEST(FigureMatch, ABodyMatchesItsOwnFigure) {
  const MatchedFigure own = matched(measured().match, measured().figure);
  EXPECT_GT(own.total, 6);
  EXPECT_GT(own.limbs[0], 1);
  EXPECT_GT(own.limbs[2], 1.5);
  EXPECT_NEAR(own.limbs[0], own.limbs[1], 0.1);
  EXPECT_GT(measured().match.head(measured().figure.head, measured().figure.headRadius), 0.9);
}

TEST(FigureMatch, WhatSticksOutMatchesWorst) {
  Figure figure = measured().figure;
  figure.limbs[0].upper = figure.limbs[0].lower = figure.limbs[0].end = Vec3::UnitX();
  EXPECT_LT(measured().match.limb(figure, 0), -1);
  EXPECT_LT(measured().match.head({0, 1.2, 0}, 0.06), -0.9);
}

TEST(FigureMatch, WhatIsHiddenIsBetterThanWhatSticksOutAndWorseThanWhatShows) {
  TriMesh inBlock = testing::figureBody(measured().figure);
  const LimbPositions positions = measured().figure.positions(0);
  testing::addCapsule(inBlock, positions.root, positions.tip, 0.1);
  const BodyVolume body = measureBody(inBlock);
  const FigureMatch match(*body.distance);
  const double hidden = match.lower(0, positions.middle, measured().figure.limbs[0].lower, 0.145, 1);
  const double shown = measured().match.lower(0, positions.middle, measured().figure.limbs[0].lower, 0.145, 1);
  EXPECT_GT(shown, 0.7);
  EXPECT_NEAR(hidden, -0.35, 0.1);
  const Vec3 beside = positions.middle + Vec3(0.1, 0, 0);
  EXPECT_EQ(measured().match.lower(0, beside, Vec3::UnitX(), 0.145, 1), -1);
}

TEST(FigureMatch, StrainIsNoneAtEase) {
  Figure figure = testing::standingFigure();
  figure.limbs[0].upper = -Vec3::UnitY();
  EXPECT_NEAR(strain(figure, 0), 0, 1e-12);
  figure.limbs[0].upperScale = 1.2;
  const double stretched = strain(figure, 0);
  EXPECT_GT(stretched, 0.1);
  figure.limbs[0].shift = {0, 0.03, 0};
  EXPECT_GT(strain(figure, 0), stretched);
}

TEST(FigureMatch, LimbsThatShareAPlaceCount) {
  Figure figure = testing::standingFigure();
  const MatchedFigure apart = matched(measured().match, figure);
  figure.limbs[3].upper = (figure.positions(2).middle - figure.socket(3)).normalized();
  MatchedFigure shared = apart;
  shared.figure = figure;
  sumUp(shared);
  EXPECT_LT(shared.total, apart.total);
}

TEST(FigureMatch, PlacesInTheTrunkAreInside) {
  const Figure& figure = measured().figure;
  EXPECT_EQ(measured().match.insideTrunk(figure, figure.waist() + Vec3(0, 0.03, 0)), 1);
  EXPECT_EQ(measured().match.insideTrunk(figure, figure.head), 1);
  EXPECT_EQ(measured().match.insideTrunk(figure, figure.positions(0).ankle), 0);
}

TEST(FigureMatch, LimbsInTheGroundMatchWorse) {
  const Figure& figure = measured().figure;
  const LimbPositions positions = figure.positions(2);
  const FigureMatch standing(*measured().body.distance);
  EXPECT_EQ(standing.inGround(figure, positions.tip), 0) << "there is none";
  const FigureMatch sunk(*measured().body.distance, {}, FigureGround{Vec3::UnitY(), positions.ankle.y() + 0.1});
  EXPECT_EQ(sunk.inGround(figure, positions.ankle), 1);
  EXPECT_EQ(sunk.inGround(figure, figure.head), 0);
  EXPECT_LT(sunk.limb(figure, 2), standing.limb(figure, 2) - 0.2);
}

TEST(FigureMatch, FiguresFarFromTheirPinsMatchWorse) {
  const Figure& figure = measured().figure;
  const LimbPositions positions = figure.positions(0);
  const FigureMatch at(*measured().body.distance, {{FigurePin::Joint::kAnkle, 0, positions.ankle}});
  EXPECT_EQ(at.pinCost(figure, 0), 0);
  const FigureMatch off(*measured().body.distance, {{FigurePin::Joint::kAnkle, 0, positions.ankle + Vec3(0.1, 0, 0)},
                                                    {FigurePin::Joint::kHead, 0, Vec3(0, 2, 0)}});
  EXPECT_GT(off.pinCost(figure, 0), 0.3);
  EXPECT_EQ(off.pinCost(figure, 0, true), 0) << "up to the elbow";
  EXPECT_EQ(off.pinCost(figure, 1), 0);
  EXPECT_NEAR(at.trunk(figure) - off.trunk(figure), 8, 1e-9) << "a pin out of reach";
  EXPECT_NEAR(at.limb(figure, 0) - off.limb(figure, 0), off.pinCost(figure, 0), 1e-9);
}

}  // namespace limber
