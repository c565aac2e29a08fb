#include "limber/core/shortest_paths.h"

#include <limits>

#include <gmock/gmock.h>

namespace limber {
namespace {

TEST(ShortestPaths, LeadRoundWhatIsFar) {
  // 0 to 1 to 2 is shorter than straight to 2; nothing leads to 3.
  const std::vector<std::vector<std::pair<int, float>>> neighbours = {{{2, 5}, {1, 1}}, {{2, 3}}, {}, {{0, 1}}};
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::vector<float> distances = {0, kFar, kFar, kFar};
  std::vector<int> from(4, -1);
  const int source = 0;
  const auto forEachNeighbour = [&](int node, const auto& visit) {
    for (const auto& [next, length] : neighbours[static_cast<std::size_t>(node)]) visit(next, length);
  };
  shortenPaths(std::span(&source, 1), distances, forEachNeighbour,
               [&](int node, int next) { from[static_cast<std::size_t>(next)] = node; });
  EXPECT_THAT(distances, ::testing::ElementsAre(0, 1, 4, kFar));
  EXPECT_THAT(from, ::testing::ElementsAre(-1, 0, 1, -1));
}

}  // namespace
}  // namespace limber
