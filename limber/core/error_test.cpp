#include "limber/core/error.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Error, SaysWhatWhereAndWhatToDoOnOneLine) {
  const Error error(ErrorCode::kBadData, "has 12 elements\nbut room for 9", "accessors[3]", "export the model again");
  EXPECT_STREQ(error.what(), "accessors[3]: has 12 elements but room for 9 (export the model again)");
  EXPECT_EQ(error.code(), ErrorCode::kBadData);
}

TEST(Error, WithinPutsTheOuterPlaceInFront) {
  const Error inner(ErrorCode::kBadData, "is cut short", "buffers[0]");
  const Error outer = inner.within("fox.glb");
  EXPECT_EQ(outer.where(), "fox.glb: buffers[0]");
  EXPECT_EQ(outer.message(), inner.message());
  EXPECT_EQ(Error(ErrorCode::kFile, "cannot be opened").within("a.obj").where(), "a.obj");
  EXPECT_EQ(outer.within("fox.glb").where(), "fox.glb: buffers[0]");
  EXPECT_EQ(outer.within("").where(), "fox.glb: buffers[0]");
  EXPECT_EQ(outer.within("fox").where(), "fox: fox.glb: buffers[0]");
}

TEST(Warnings, SayHowOftenWhereThatWasMoreThanOnce) {
  EXPECT_EQ(warningText({"lights", "lights are left out", "", 12}), "lights are left out (12)");
  EXPECT_EQ(warningText({"lights", "lights are left out", "", 1}), "lights are left out");
}

TEST(Warnings, AreCountedByKindInTheOrderMet) {
  Warnings warnings;
  warnings.add("b", "second letter", "first place");
  warnings.add("a", "first letter", {}, 5);
  warnings.add("b", "ignored", "other place", 2);
  warnings.add("c", "never happened", {}, 0);
  ASSERT_EQ(warnings.items().size(), 2u);
  EXPECT_EQ(warnings.items()[0].kind, "b");
  EXPECT_EQ(warnings.items()[0].count, 3u);
  EXPECT_EQ(warnings.items()[0].where, "first place");
  EXPECT_EQ(warnings.items()[1].count, 5u);

  Warnings all;
  all.add("a", "first letter");
  all.append(warnings);
  EXPECT_EQ(all.items()[0].count, 6u);
  EXPECT_EQ(all.items()[1].count, 3u);
}

}  // namespace
}  // namespace limber
