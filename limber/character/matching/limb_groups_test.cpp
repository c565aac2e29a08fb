#include "limber/character/matching/limb_groups.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

using Groups = std::vector<std::vector<Index>>;

TEST(LimbGroups, AsManyStayOneByOne) {
  const std::vector<Index> limb = {4, 5, 9};
  const std::vector<double> own = {0, 0.2, 0.3}, others = {0, 0.5, 0.9};
  EXPECT_EQ(groupedAlong(limb, own, others), Groups({{4}, {5}, {9}}));
}

TEST(LimbGroups, FewerTakeThoseBetweenAlong) {
  const std::vector<Index> limb = {1, 2, 3, 4, 5};
  const std::vector<double> own = {0, 0.1, 0.45, 0.6, 0.9};
  EXPECT_EQ(groupedAlong(limb, own, std::vector<double>{0, 0.5}), Groups({{1, 2}, {3, 4, 5}}));
  EXPECT_EQ(groupedAlong(limb, own, std::vector<double>{0}), Groups({{1, 2, 3, 4, 5}}));
  EXPECT_EQ(groupedAlong(limb, own, std::vector<double>{0, 0.95, 1}), Groups({{1, 2, 3}, {4}, {5}}))
      << "one is left for each";
}

TEST(LimbGroups, MoreAreAsTheyAre) {
  const std::vector<Index> limb = {7, 8};
  EXPECT_EQ(groupedAlong(limb, std::vector<double>{0, 0.5}, std::vector<double>{0, 0.3, 0.6}), Groups({{7}, {8}}));
}

}  // namespace
}  // namespace limber
