#include "limber/rigging/figure/limb_finder.h"

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

TEST(LimbFinder, FindsTheLimbsOfATrunkInAnyPose) {
  for (const Figure& figure : {testing::standingFigure(), testing::crouchingFigure()}) {
    const BodyVolume body = measureBody(testing::figureBody(figure));
    const FigureMatch match(*body.distance);
    const LimbFinder finder(body, match, figure.stature);
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      const std::vector<LimbFinder::Candidate> found = finder.find(figure, limb, {40, 6, true});
      ASSERT_FALSE(found.empty()) << limb;
      EXPECT_LE(found.size(), 6u);
      Figure best = figure;
      best.limbs[limb] = found.front().bones;
      EXPECT_LT((best.positions(limb).middle - figure.positions(limb).middle).norm(), 0.05) << limb;
      EXPECT_LT((best.positions(limb).ankle - figure.positions(limb).ankle).norm(), 0.08) << limb;
    }
  }
}

TEST(LimbFinder, CandidatesAreAllowedSortedAndApart) {
  const Figure figure = testing::standingFigure();
  const BodyVolume body = measureBody(testing::figureBody(figure));
  const FigureMatch match(*body.distance);
  const LimbFinder finder(body, match, figure.stature);
  const std::vector<LimbFinder::Candidate> found = finder.find(figure, 2, {40, 8, true});
  ASSERT_GT(found.size(), 1u);
  for (std::size_t i = 0; i < found.size(); ++i) {
    Figure trial = figure;
    trial.limbs[2] = found[i].bones;
    EXPECT_TRUE(limbAllowed(trial, 2));
    EXPECT_NEAR(found[i].match, match.limb(trial, 2), 1e-12);
    EXPECT_GE(found[i == 0 ? 0 : i - 1].match, found[i].match);
  }
}

TEST(LimbFinder, OneWhoHasNoBodyAroundHasNoLimbs) {
  TriMesh ball;
  testing::addCapsule(ball, {0, 0.99, 0}, {0, 1, 0}, 0.06);
  const BodyVolume body = measureBody(ball);
  const FigureMatch match(*body.distance);
  const LimbFinder finder(body, match, 1);
  EXPECT_TRUE(finder.find(testing::standingFigure(), 2, {40, 8, true}).empty());
}

}  // namespace limber
