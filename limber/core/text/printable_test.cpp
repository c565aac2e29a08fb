#include "limber/core/text/printable.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Printable, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(printable("\x1b]0;OWNED\x07\x1b[31mred"), "\\x1b]0;OWNED\\x07\\x1b[31mred");
  EXPECT_EQ(printable("a\r\nlimber: forged\x7f\t"), "a\\x0d\\x0alimber: forged\\x7f\\x09");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\u009b2J");
}

TEST(Shortened, CutsBetweenCharacters) {
  EXPECT_EQ(shortened("Hüfte"), "Hüfte");
  EXPECT_EQ(shortened(std::string(100, 'a')), std::string(100, 'a'));
  EXPECT_EQ(shortened(std::string(1 << 20, '1')), std::string(100, '1') + "...");
  EXPECT_EQ(shortened("Hüfte", 2), "H...");
  EXPECT_EQ(shortened("Hüfte", 3), "Hü...");
  EXPECT_EQ(shortened("\x07\x07", 1), "\\x07...");
}

TEST(Printable, LeavesWordsAlone) {
  const std::string words = "Hüfte 腰 \xc2\xa0 ~ \"C:\\x\"";
  EXPECT_EQ(printable(words), words);
  EXPECT_EQ(printable("\xc2"), "\xc2");
  EXPECT_EQ(printableText("a\tb\nc\r\n"), "a\tb\nc\\x0d\n");
}

}  // namespace
}  // namespace limber
