#include "limber/study/command_words.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(CommandWords, AreTheLastLineWithoutItsSpeaker) {
  EXPECT_EQ(commandWords("limber: warning\nlimber: a.obj: is empty\n\n"), "a.obj: is empty");
  EXPECT_EQ(commandWords("killed"), "killed");
  EXPECT_EQ(commandWords(""), "");
  EXPECT_EQ(commandWords(std::string(2000, 'a')).size(), 1000u);
}

TEST(Replaced, GoesOnBehindWhatItPutIn) {
  EXPECT_EQ(replaced("a/b and a/b", "a/b", "b"), "b and b");
  EXPECT_EQ(replaced("aa", "a", "aa"), "aaaa");
}

}  // namespace
}  // namespace limber
