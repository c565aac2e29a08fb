#include "half_blocks.h"

#include <gtest/gtest.h>

namespace limber::cli {
namespace {

TEST(HalfBlocksTest, TwoRowsShareALine) {
  EXPECT_EQ(halfBlocks({4,
                        {0, 0, 1, 1,  //
                         0, 1, 0, 1}},
                       0, false),
            " \u2584\u2580\u2588\n");
}

TEST(HalfBlocksTest, AnOddRowStandsOverALightOne) {
  EXPECT_EQ(halfBlocks({2, {1, 1, 1, 0, 0, 1}}, 0, false), "\u2588\u2580\n \u2580\n");
}

TEST(HalfBlocksTest, TheMarginIsAllAround) {
  EXPECT_EQ(halfBlocks({1, {1}}, 1, false), " \u2584 \n   \n");
  EXPECT_EQ(halfBlocks({1, {1}}, 2, false), "     \n  \u2580  \n     \n");
}

TEST(HalfBlocksTest, ColoursHoldForOneLine) {
  EXPECT_EQ(halfBlocks({1, {1}}, 0, true), "\x1b[30;107m\u2580\x1b[0m\n");
}

TEST(HalfBlocksTest, NothingIsNothing) {
  EXPECT_EQ(halfBlocks({}, 0, false), "");
}

}  // namespace
}  // namespace limber::cli
