#include "limber/crowd/mixed_turns.h"

#include <gtest/gtest.h>

#include <set>

namespace limber {
namespace {

std::vector<Index> draws(Index count, std::uint64_t seed, std::size_t number) {
  MixedTurns turns(count, seed);
  std::vector<Index> drawn;
  for (std::size_t i = 0; i < number; ++i) drawn.push_back(turns.next());
  return drawn;
}

TEST(MixedTurns, DrawEachOnceBeforeOneComesTwice) {
  const std::vector<Index> drawn = draws(7, 3, 21);
  for (std::size_t round = 0; round < 3; ++round) {
    const auto first = drawn.begin() + 7 * round;
    EXPECT_EQ(std::set<Index>(first, first + 7).size(), 7u) << round;
  }
  EXPECT_FALSE(std::equal(drawn.begin(), drawn.begin() + 7, drawn.begin() + 7));
  EXPECT_EQ(draws(1, 3, 4), std::vector<Index>(4, 0));
}

TEST(MixedTurns, AreTheSameForASeedAlone) {
  EXPECT_EQ(draws(7, 3, 21), draws(7, 3, 21));
  EXPECT_NE(draws(7, 3, 21), draws(7, 4, 21));
}

}  // namespace
}  // namespace limber
