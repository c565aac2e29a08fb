#include "limber/actions/option_spelling.h"

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

TEST(OptionSpelling, OfAdviceTheMessages) {
  Warnings advice;
  advice.add("not-upright", "`upright` rotates it", "`up`", 3);
  const Warnings written = spellOptions(advice, OptionSpelling::kProgram);
  ASSERT_EQ(written.items().size(), 1u);
  const Warning& one = written.items().front();
  EXPECT_EQ(one.kind, "not-upright");
  EXPECT_EQ(one.message, "--upright rotates it");
  EXPECT_EQ(one.where, "`up`");
  EXPECT_EQ(one.count, 3u);
}

TEST(OptionSpelling, OtherTextStays) {
  for (const char* text : {"", "nothing to say", "one ` alone", "a `File.glb` of a user's", "``", "`a: `", "`: a`",
                           "`model`.glb", "`joint: replace`", "`up: +y`"}) {
    expectSpelled(text, text, text, text);
  }
  expectSpelled("` and `up`", "` and --up", "` and up", "` and up");
}

TEST(OptionSpelling, OfAnErrorTheRemedyAndAnOptionThatIsToBlame) {
  const auto reported = [](const char* message, const char* where, const char* remedy) {
    return std::string(
        spellOptions(Error(ErrorCode::kBadArgument, message, where, remedy), OptionSpelling::kProgram).what());
  };
  EXPECT_EQ(reported("takes 1 to 8, not `up`", "`max-influences`", "leave `up` out"),
            "--max-influences: takes 1 to 8, not `up` (leave --up out)");
  EXPECT_EQ(reported("no joint", "`up`.glb", ""), "`up`.glb: no joint");
  EXPECT_EQ(spellOptions(Error(ErrorCode::kLimit, ""), OptionSpelling::kProgram).code(), ErrorCode::kLimit);
}

TEST(OptionSpelling, AnOptionStandsAlone) {
  for (const char* text : {"`up`", "`existing-rig: replace`"}) EXPECT_TRUE(isOption(text)) << text;
  for (const char* text : {"", "`", "``", "up", "`up", "`up`.glb", "`up` and `front`", "`model`"}) {
    EXPECT_FALSE(isOption(text)) << text;
  }
}

}  // namespace limber
