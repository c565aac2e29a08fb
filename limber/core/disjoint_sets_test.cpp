#include "limber/core/disjoint_sets.h"

#include <random>

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(DisjointSets, AgreeWithRelabellingEverything) {
  constexpr Index kCount = 60;
  std::mt19937 random(1);
  DisjointSets sets(kCount);
  std::vector<Index> label(kCount);
  std::iota(label.begin(), label.end(), Index{0});
  for (int step = 0; step < 200; ++step) {
    const Index a = random() % kCount, b = random() % kCount;
    const Index kept = std::min(label[a], label[b]), gone = std::max(label[a], label[b]);
    EXPECT_EQ(sets.unite(a, b), kept != gone);
    std::replace(label.begin(), label.end(), gone, kept);
    for (Index i = 0; i < kCount; ++i) ASSERT_EQ(sets.find(i), label[i]);
    std::vector<Index> names = label;
    std::sort(names.begin(), names.end());
    EXPECT_EQ(sets.count(), static_cast<std::size_t>(std::unique(names.begin(), names.end()) - names.begin()));
  }
}

}  // namespace
}  // namespace limber
