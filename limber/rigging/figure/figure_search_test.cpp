#include "limber/rigging/figure/figure_search.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

namespace {

void expectLike(const Figure& found, const Figure& truth) {
  EXPECT_LT((found.head - truth.head).norm(), 0.03);
  EXPECT_LT((found.hips() - truth.hips()).norm(), 0.06);
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    const LimbPositions a = found.positions(limb), b = truth.positions(limb);
    EXPECT_LT((a.root - b.root).norm(), 0.07) << limb;
    EXPECT_LT((a.middle - b.middle).norm(), 0.07) << limb;
    EXPECT_LT((a.ankle - b.ankle).norm(), 0.07) << limb;
  }
}

std::optional<MatchedFigure> find(const BodyVolume& body, const FigureSearch& search = {}) {
  Progress progress;
  return findFigure(body, search, progress);
}

const BodyVolume& statue() {
  static const BodyVolume body = measureBody(testing::statueOf(testing::crouchingFigure()));
  return body;
}

}  // namespace

TEST(FigureSearch, FindsOneWhoCrouchesOnABlock) {
  const std::optional<MatchedFigure> found = find(statue());
  ASSERT_TRUE(found);
  EXPECT_GT(found->total, 8);
  expectLike(found->figure, testing::crouchingFigure());
}

TEST(FigureSearch, FeetTellTheFrontOfOneWhoStands) {
  const BodyVolume body = measureBody(testing::figureBody(testing::standingFigure()));
  const std::optional<MatchedFigure> found = find(body);
  ASSERT_TRUE(found);
  EXPECT_GT(found->figure.pelvis.col(2).z(), 0.8);
  EXPECT_GT(found->figure.positions(0).ankle.x(), 0) << "its left is at the left";
}

TEST(FigureSearch, GivesTheSameWithAnyNumberOfThreads) {
  setThreadCount(1);
  const std::optional<MatchedFigure> one = find(statue());
  setThreadCount(3);
  const std::optional<MatchedFigure> three = find(statue());
  setThreadCount(0);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->total, three->total);
  EXPECT_EQ(one->figure.positions(0).tip, three->figure.positions(0).tip);
}

TEST(FigureSearch, KeepsToTheFrontThatIsGiven) {
  FigureSearch search;
  search.front = -Vec3::UnitZ();
  const std::optional<MatchedFigure> found = find(statue(), search);
  ASSERT_TRUE(found);
  EXPECT_LT((found->figure.chest.col(2) + found->figure.pelvis.col(2)).z(), 0);
  EXPECT_LT(found->total, find(statue())->total) << "it faces the other way";
}

TEST(FigureSearch, ComesToItsPins) {
  const Figure truth = testing::crouchingFigure();
  // The left hand, which points forward, shall rest beside the knee.
  const Vec3 position = truth.positions(2).middle + Vec3(0.06, 0.03, 0);
  FigureSearch search;
  search.pins = {{FigurePin::Joint::kAnkle, 0, position}};
  const std::optional<MatchedFigure> found = find(statue(), search);
  ASSERT_TRUE(found);
  EXPECT_LT((found->figure.positions(0).ankle - position).norm(), 0.1);
}

TEST(FigureSearch, MayBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(findFigure(statue(), {}, progress), Error);
}

TEST(FigureSearch, ThereIsNobodyInABar) {
  TriMesh bar;
  testing::addCapsule(bar, {0, 0, 0}, {0, 1, 0}, 0.1);
  const BodyVolume body = measureBody(bar);
  const std::optional<MatchedFigure> found = find(body);
  EXPECT_TRUE(!found || found->total < 4);
}

}  // namespace limber
