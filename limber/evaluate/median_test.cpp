#include "limber/evaluate/median.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Median, IsTheMiddleOrBetweenTheTwoMiddleValues) {
  EXPECT_EQ(median({7}), 7);
  EXPECT_EQ(median({9, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 9, 2}), 3);
}

}  // namespace
}  // namespace limber
