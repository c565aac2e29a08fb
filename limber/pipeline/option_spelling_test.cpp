#include "limber/pipeline/option_spelling.h"

#include <gtest/gtest.h>

namespace limber {

namespace {

void expectSpelled(std::string_view text, std::string_view program, std::string_view python, std::string_view page) {
  EXPECT_EQ(spellOptions(text, OptionSpelling::kProgram), program);
  EXPECT_EQ(spellOptions(text, OptionSpelling::kPython), python);
  EXPECT_EQ(spellOptions(text, OptionSpelling::kJavaScript), page);
}

}  // namespace

TEST(OptionSpelling, EachCallerReadsItsOwnNames) {
  expectSpelled("`max-influences`", "--max-influences", "max_influences", "maxInfluences");
  expectSpelled("`existing-rig: replace` takes it out", "--replace-rig takes it out",
                "existing_rig=\"replace\" takes it out", "existingRig: 'replace' takes it out");
  expectSpelled("`existing-rig: keep-skeleton`", "--keep-skeleton", "existing_rig=\"keep-skeleton\"",
                "existingRig: 'keep-skeleton'");
  expectSpelled("`up` and `front`, or `template: auto`", "--up and --front, or --template auto",
                "up and front, or template=\"auto\"", "up and front, or template: 'auto'");
  expectSpelled("`pins`", "--pin", "pins", "pins");
}

TEST(OptionSpelling, OtherTextStays) {
  for (const char* text : {"", "nothing to say", "one ` alone", "a `File.glb` of a user's", "``", "`a: `", "`: a`"}) {
    expectSpelled(text, text, text, text);
  }
  expectSpelled("` and `up`", "` and --up", "` and up", "` and up");
}

}  // namespace limber
