#include "limber/jobs/last_line.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(LastLine, IsTheLastThatSaysSomething) {
  EXPECT_EQ(lastLine("one\ntwo\n \t\r\n\n", 99), "two");
  EXPECT_EQ(lastLine("10 %\r  20 %\r", 99), "20 %");
  EXPECT_EQ(lastLine("alone", 99), "alone");
  EXPECT_EQ(lastLine("", 99), "");
  EXPECT_EQ(lastLine(" \n\t\n", 99), "");
}

TEST(LastLine, IsOneLineOfPlainCharacters) {
  EXPECT_EQ(lastLine("no\tcheckpoint\x1b[0m\n", 99), "no checkpoint [0m");
  EXPECT_EQ(lastLine("a long story", 6), "a long");
  EXPECT_EQ(lastLine("caf\xc3\xa9", 99), "caf\xc3\xa9");
}

}  // namespace
}  // namespace limber
