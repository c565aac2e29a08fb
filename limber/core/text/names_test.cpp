#include "limber/core/text/names.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Names, OnlyLettersOfAsciiChangeTheirCase) {
  EXPECT_EQ(lowerCase("Fox 07.GLB_[\xc3\x84]"), "fox 07.glb_[\xc3\x84]");
}

TEST(Names, TheExtensionIsWhatStandsBehindTheLastDot) {
  EXPECT_EQ(lowerExtension("folder.d/Fox.old.GlTF"), ".gltf");
  EXPECT_EQ(lowerExtension("folder.d/fox"), "");
  EXPECT_EQ(lowerExtension("-"), "");
}

TEST(Names, AnUnknownNameListsTheKnownOnes) {
  struct Entry {
    std::string_view name;
    int value;
  };
  constexpr std::array<Entry, 2> kTable = {{{"one", 1}, {"two", 2}}};
  EXPECT_EQ(findByName(kTable, "number", "two").value, 2);
  try {
    findByName(kTable, "number", "three");
    FAIL() << "found what is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_STREQ(error.what(), "no number is called 'three' (there are: one, two)");
  }
}

}  // namespace
}  // namespace limber
