#include "limber/core/text/split_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

using ::testing::ElementsAre;

TEST(SplitText, EmptyPartsCount) {
  EXPECT_THAT(splitAt("a\tbc\t\td", '\t'), ElementsAre("a", "bc", "", "d"));
  EXPECT_THAT(splitAt("one\n", '\n'), ElementsAre("one", ""));
  EXPECT_THAT(splitAt("", ','), ElementsAre(""));
}

}  // namespace
}  // namespace limber
