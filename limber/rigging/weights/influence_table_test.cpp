// The strongest few, against a sort of all.
#include "limber/rigging/weights/influence_table.h"

#include <algorithm>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(InfluenceTable, KeepsTheStrongestInWhateverOrderTheyCome) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::pair<float, Index>> offers;
    for (Index joint = 0; joint < 12; ++joint) {
      offers.push_back({static_cast<float>(random() % 6) / 5, joint});  // many ties, some zeros
    }
    std::shuffle(offers.begin(), offers.end(), random);
    InfluenceTable table(2, 4);
    for (const auto& [weight, joint] : offers) table.offer(1, joint, weight);
    std::sort(offers.begin(), offers.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    for (Index k = 0; k < 4; ++k) {
      EXPECT_EQ(table.weightsOf(1)[k], offers[k].first);
      EXPECT_EQ(table.jointsOf(1)[k], offers[k].first > 0 ? offers[k].second : 0);
      EXPECT_EQ(table.weightsOf(0)[k], 0) << "another row";
    }
  }
}

TEST(InfluenceTable, NothingBelowZero) {
  InfluenceTable table(1, 2);
  table.offer(0, 5, -0.5f);
  table.offer(0, 6, 0.0f);
  EXPECT_EQ(table.weightsOf(0)[0], 0);
  EXPECT_EQ(table.jointsOf(0)[0], 0u);
}

}  // namespace
}  // namespace limber
