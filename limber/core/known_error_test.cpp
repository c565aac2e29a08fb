#include "limber/core/known_error.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(KnownError, IsAnErrorWithAKindAndTheValuesOfItsSentence) {
  try {
    throw KnownError(ErrorKind::kNameTaken, {ErrorCode::kBadArgument, "there is a joint called 'hips' already"},
                     {{"name", "hips"}});
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is a joint called 'hips' already");
    const auto* known = dynamic_cast<const KnownError*>(&error);
    ASSERT_NE(known, nullptr);
    EXPECT_EQ(errorKindName(known->kind()), "name-taken");
    ASSERT_EQ(known->values().size(), 1u);
    EXPECT_EQ(known->values()[0].value, "hips");
  }
}

TEST(KnownError, KeepsItsKindWithinAnOuterPlace) {
  try {
    throwWithin(KnownError(ErrorKind::kEmptyFile, {ErrorCode::kBadData, "is empty"}), "fox.glb");
  } catch (const KnownError& error) {
    EXPECT_EQ(error.where(), "fox.glb");
    EXPECT_EQ(error.kind(), ErrorKind::kEmptyFile);
  }
}

TEST(KnownError, OthersStayAsTheyAreWithinAnOuterPlace) {
  try {
    throwWithin(Error(ErrorCode::kBadData, "is cut short"), "fox.glb");
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "fox.glb");
    EXPECT_EQ(dynamic_cast<const KnownError*>(&error), nullptr);
  }
}

}  // namespace
}  // namespace limber
