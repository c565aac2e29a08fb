#include "limber/motion/mix/gait/stride_match.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// Feet 0 and 1 in turn.
std::vector<Footfall> steps(int count, Index first, double seconds, double begin = 0.2) {
  std::vector<Footfall> falls;
  for (int i = 0; i < count; ++i) falls.push_back({(first + static_cast<Index>(i)) % 2, begin + i * seconds});
  return falls;
}

// Where two moments meet: as many steps from the first footfall of the same foot.
TEST(StrideMatch, AWalkOfFourStepsAndARunOfSix) {
  const std::vector<Footfall> walk = steps(4, 1, 0.55), run = steps(6, 0, 0.35);
  const StridePhases phases = matchStrides(walk, run).front();
  EXPECT_EQ(phases.matched, 4u);
  EXPECT_EQ(phases.stride, 2);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(phases.b.when(phases.a.at(0.2 + 0.55 * i)), 0.2 + 0.35 * (i + 1), 1e-9);
}

TEST(StrideMatch, TheOtherOrderIsTheSameMatch) {
  for (const Index first : {0, 1}) {
    const std::vector<Footfall> a = steps(5, first, 0.5), b = steps(5, 1 - first, 0.4);
    const StridePhases one = matchStrides(a, b).front(), other = matchStrides(b, a).front();
    for (double t = 0; t < 2; t += 0.1) {
      EXPECT_NEAR(one.b.when(one.a.at(t)), other.a.when(other.b.at(t)), 1e-9);
    }
  }
}

TEST(StrideMatch, EachWayIsFoundAndFeetAgreeInAll) {
  const std::vector<Footfall> a = steps(3, 0, 0.5), b = steps(4, 0, 0.5);
  const std::vector<StridePhases> all = matchStrides(a, b);
  EXPECT_EQ(all.size(), 3u);  // the first of a on the first, on the third, and two before the first
  for (const StridePhases& phases : all) {
    const double shift = (phases.b.when(0) - 0.2) / 0.5;
    EXPECT_NEAR(std::remainder(shift, 2), 0, 1e-9);
  }
}

// A walk and a gallop: hind left, fore left, hind right, fore right against all but two at once.
TEST(StrideMatch, OtherOrdersAreMatchedByOneFoot) {
  std::vector<Footfall> walk, gallop;
  for (int i = 0; i < 4; ++i) {
    for (const Index foot : {0u, 1u, 2u, 3u}) walk.push_back({foot, i + 0.25 * foot});
    for (const Index foot : {0u, 2u, 3u, 1u}) gallop.push_back({foot, 0.5 * i + 0.03 * foot});
  }
  std::sort(gallop.begin(), gallop.end(), [](auto& x, auto& y) { return x.seconds < y.seconds; });
  std::swap(gallop[1].foot, gallop[2].foot);
  const std::vector<StridePhases> found = matchStrides(walk, gallop);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().stride, 1);
  EXPECT_EQ(found.front().matched, 4u);
  EXPECT_NEAR(found.front().b.when(found.front().a.at(1)), 0.5, 0.1);
}

TEST(StrideMatch, OneFootfallIsNoStep) {
  EXPECT_TRUE(matchStrides(steps(1, 0, 0.5), steps(6, 0, 0.5)).empty());
  EXPECT_TRUE(matchStrides({}, {}).empty());
}

}  // namespace
}  // namespace limber
