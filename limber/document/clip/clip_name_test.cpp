#include "limber/document/clip/clip_name.h"

#include <vector>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

TEST(ClipName, InFullGoesBeforeWhatIsBehindTheBar) {
  const std::vector<std::string> names = {"Armature|Walk", "Walk", "Armature|Run", "Other|Run", ""};
  EXPECT_EQ(clipNamed(names, "Walk", "a.glb"), 1u);
  EXPECT_EQ(clipNamed(names, "Armature|Walk", "a.glb"), 0u);
  EXPECT_EQ(clipNamed(names, "Run", "a.glb"), 2u);
}

TEST(ClipName, ThatIsNotThereIsRefusedWithThoseThatAre) {
  const std::vector<std::string> names = {"Walk", "Run"};
  try {
    clipNamed(names, "Jump", "a.glb");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_STREQ(error.what(), "a.glb: there is no clip called 'Jump' (there are: Walk, Run)");
  }
  EXPECT_THROW(clipNamed({}, "Jump", "a.glb"), Error);
}

}  // namespace
}  // namespace limber
