#include "limber/batch/path_pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(PathPattern, MatchesWithinAPart) {
  EXPECT_TRUE(matchesPathPattern("hero.obj", "*.obj"));
  EXPECT_TRUE(matchesPathPattern("hero.obj", "h?ro.*"));
  EXPECT_TRUE(matchesPathPattern("aXbXc", "a*b*c"));
  EXPECT_TRUE(matchesPathPattern("abcbc", "a*bc"));  // the first b is the wrong one
  EXPECT_FALSE(matchesPathPattern("hero.obj", "*.glb"));
  EXPECT_FALSE(matchesPathPattern("a/hero.obj", "*.obj"));
  EXPECT_FALSE(matchesPathPattern("ac", "a?c"));
}

TEST(PathPattern, MatchesFolders) {
  EXPECT_TRUE(matchesPathPattern("hero.obj", "**/*.obj"));
  EXPECT_TRUE(matchesPathPattern("a/b/hero.obj", "**/*.obj"));
  EXPECT_TRUE(matchesPathPattern("a/b/c/hero.obj", "a/**/c/*.obj"));
  EXPECT_TRUE(matchesPathPattern("a/c/hero.obj", "a/**/c/*.obj"));
  EXPECT_FALSE(matchesPathPattern("b/c/hero.obj", "a/**/*.obj"));
  EXPECT_TRUE(matchesPathPattern("a/b", "**"));
}

TEST(PathPattern, FindsFiles) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "a" / "deep");
  for (const char* name : {"one.obj", "a/two.obj", "a/deep/three.obj", "a/four.glb"}) {
    std::ofstream(folder.path() / name) << "x";
  }
  EXPECT_THAT(filesMatching(folder.path(), "*.obj"), ElementsAre("one.obj"));
  EXPECT_THAT(filesMatching(folder.path(), "a/*"), ElementsAre("a/four.glb", "a/two.obj"));
  EXPECT_THAT(filesMatching(folder.path(), "a/**/*.obj"), ElementsAre("a/deep/three.obj", "a/two.obj"));
  EXPECT_THAT(filesMatching(folder.path(), "*.stl"), IsEmpty());
}

}  // namespace
}  // namespace limber
