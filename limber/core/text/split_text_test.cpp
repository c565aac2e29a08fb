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

TEST(SplitText, WordsAreBetweenBlanks) {
  EXPECT_THAT(wordsIn("  a bc  d"), ElementsAre("a", "bc", "d"));
  EXPECT_THAT(wordsIn("a\tb c\r", " \t\r"), ElementsAre("a", "b", "c"));
  EXPECT_TRUE(wordsIn("").empty());
  EXPECT_TRUE(wordsIn("  ").empty());
}

}  // namespace
}  // namespace limber
