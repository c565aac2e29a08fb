#include "limber/core/text/list_lines.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(ListLines, AreThoseThatSaySomething) {
  const auto lines = listLines("\xef\xbb\xbf one.obj\r\n\n# heroes\n#\n \t\n  #2 b.obj \n\ttwo.obj");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].text, "one.obj");
  EXPECT_EQ(lines[1].text, "#2 b.obj");
  EXPECT_EQ(lines[1].number, 6u);
  EXPECT_EQ(lines[2].text, "two.obj");
  EXPECT_TRUE(listLines("").empty());
}

}  // namespace
}  // namespace limber
