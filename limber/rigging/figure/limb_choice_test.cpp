#include "limber/rigging/figure/limb_choice.h"

#include <gtest/gtest.h>

#include "limber/core/random.h"
#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

TEST(LimbChoice, TakesTheBestOfLimbsThatAreApart) {
  const Figure figure = testing::standingFigure();
  LimbCandidates candidates;
  for (int limb = 0; limb < kFigureLimbs; ++limb) candidates[limb] = {{figure.limbs[limb], 1}, {figure.limbs[limb], 0}};
  EXPECT_EQ(chooseLimbs(figure, candidates), (std::array<std::size_t, kFigureLimbs>{0, 0, 0, 0}));
}

TEST(LimbChoice, AvoidsLimbsInOnePlaceWhereThatIsWorthIt) {
  const Figure figure = testing::standingFigure();
  LimbCandidates candidates;
  for (int limb = 0; limb < kFigureLimbs; ++limb) candidates[limb] = {{figure.limbs[limb], 1}};
  FigureLimb crossed = figure.limbs[3];
  crossed.upper = (figure.positions(2).middle - figure.socket(3)).normalized();
  candidates[3] = {{crossed, 1.1}, {figure.limbs[3], 1}};
  EXPECT_EQ(chooseLimbs(figure, candidates)[3], 1u);
  candidates[3] = {{crossed, 5}, {figure.limbs[3], 1}};
  EXPECT_EQ(chooseLimbs(figure, candidates)[3], 0u);
}

TEST(LimbChoice, IsTheBestOfAllWhereTwoLimbsAreInQuestion) {
  Random random(1);
  const Figure figure = testing::crouchingFigure();
  for (int trial = 0; trial < 20; ++trial) {
    LimbCandidates candidates;
    for (int limb = 0; limb < kFigureLimbs; ++limb) candidates[limb] = {{figure.limbs[limb], 1}};
    for (const int leg : {2, 3}) {
      candidates[leg].clear();
      for (int i = 0; i < 5; ++i) {
        FigureLimb bones = figure.limbs[leg];
        const double x = random.normal(), z = random.normal();
        bones.upper = Vec3(0.4 * x, -1, 0.4 * z).normalized();
        candidates[leg].push_back({bones, random.uniform()});
      }
    }
    const auto total = [&](const std::array<std::size_t, kFigureLimbs>& choice) {
      MatchedFigure matched;
      matched.figure = figure;
      for (int limb = 0; limb < kFigureLimbs; ++limb) {
        matched.figure.limbs[limb] = candidates[limb][choice[limb]].bones;
        matched.limbs[limb] = candidates[limb][choice[limb]].match;
      }
      sumUp(matched);
      return matched.total;
    };
    double most = -1e9;
    for (std::size_t left = 0; left < 5; ++left) {
      for (std::size_t right = 0; right < 5; ++right) most = std::max(most, total({0, 0, left, right}));
    }
    EXPECT_NEAR(total(chooseLimbs(figure, candidates)), most, 1e-12);
  }
}

}  // namespace limber
