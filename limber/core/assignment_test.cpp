#include "limber/core/assignment.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace limber {

namespace {

// The minimum over all pairings.
double minSum(const std::vector<std::vector<double>>& costs) {
  const std::size_t rows = costs.size(), columns = costs[0].size();
  std::vector<std::size_t> order(std::max(rows, columns));
  std::iota(order.begin(), order.end(), 0);
  double least = std::numeric_limits<double>::infinity();
  do {
    double sum = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i < rows && order[i] < columns) sum += costs[i][order[i]];
    }
    least = std::min(least, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

}  // namespace

TEST(Assignment, IsTheCheapestOfAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> cost(0, 10);
  for (const auto& [rows, columns] :
       {std::pair(1, 1), std::pair(4, 4), std::pair(3, 6), std::pair(6, 3), std::pair(6, 6)}) {
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<std::vector<double>> costs(rows, std::vector<double>(columns));
      for (auto& row : costs) std::generate(row.begin(), row.end(), [&] { return cost(random); });
      const std::vector<std::optional<Index>> pairs = cheapestPairs(costs);
      ASSERT_EQ(pairs.size(), costs.size());
      double sum = 0;
      std::vector<int> taken(columns, 0);
      for (int r = 0; r < rows; ++r) {
        if (!pairs[r]) continue;
        sum += costs[r][*pairs[r]];
        ++taken[*pairs[r]];
      }
      EXPECT_NEAR(sum, minSum(costs), 1e-9);
      EXPECT_LE(*std::max_element(taken.begin(), taken.end()), 1);
      EXPECT_EQ(std::count_if(pairs.begin(), pairs.end(), [](const auto& p) { return p.has_value(); }),
                std::min(rows, columns));
    }
  }
  EXPECT_TRUE(cheapestPairs({}).empty());
}

}  // namespace limber
