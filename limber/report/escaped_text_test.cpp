#include "limber/report/escaped_text.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(HtmlText, EscapesAllThatHasAMeaning) {
  EXPECT_EQ(htmlText("a<b>&\"'\x01z"), "a&lt;b&gt;&amp;&quot;&#39; z");
  EXPECT_EQ(htmlText("größe"), "größe");
}

TEST(MarkdownText, EscapesAllThatHasAMeaning) {
  EXPECT_EQ(markdownText("a|b\n*c*"), "a\\|b \\*c\\*");
}

}  // namespace
}  // namespace limber
