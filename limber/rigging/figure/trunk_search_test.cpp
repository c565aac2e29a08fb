#include "limber/rigging/figure/trunk_search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

namespace {

struct Crouching {
  Figure figure = testing::crouchingFigure();
  BodyVolume body = measureBody(testing::statueOf(figure));
  FigureMatch match{*body.distance};
};

const Crouching& crouching() {
  static const Crouching person;
  return person;
}

}  // namespace

TEST(TrunkSearch, TheRoundestBallIsTheHead) {
  const std::vector<HeadBall> heads = findHeads(crouching().body, crouching().match, Vec3::UnitY());
  ASSERT_FALSE(heads.empty());
  EXPECT_LT((heads.front().middle - crouching().figure.head).norm(), 0.02);
  EXPECT_NEAR(heads.front().radius, crouching().figure.headRadius, 0.01);
  for (std::size_t i = 1; i < heads.size(); ++i) EXPECT_LE(heads[i].match, heads[i - 1].match);
}

TEST(TrunkSearch, StaturesOfAHeadHaveTheTrueOneAmongThem) {
  const std::vector<double> statures = staturesFor({Vec3::Zero(), crouching().figure.headRadius, 1});
  EXPECT_LT(*std::min_element(statures.begin(), statures.end()), 1.0);
  EXPECT_GT(*std::max_element(statures.begin(), statures.end()), 1.0);
}

TEST(TrunkSearch, FindsABentTrunkWithBothItsFronts) {
  const HeadBall head = findHeads(crouching().body, crouching().match, Vec3::UnitY()).front();
  const std::vector<MatchedFigure> trunks = findTrunks(crouching().body, crouching().match, head, 1, Vec3::UnitY(), 20);
  ASSERT_GE(trunks.size(), 2u);
  EXPECT_LT((trunks[0].figure.hips() - crouching().figure.hips()).norm(), 0.08);
  EXPECT_LT((trunks[0].figure.chest.col(2) + trunks[1].figure.chest.col(2)).norm(), 1e-9);
  for (const MatchedFigure& trunk : trunks) {
    EXPECT_NEAR(trunk.figure.chest.determinant(), 1, 1e-9);
    EXPECT_NEAR(trunk.figure.pelvis.determinant(), 1, 1e-9);
    EXPECT_NEAR(trunk.trunk, crouching().match.trunk(trunk.figure), 0.2) << "the same from both sides";
  }
}

}  // namespace limber
