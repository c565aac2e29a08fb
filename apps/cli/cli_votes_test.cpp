// limber evaluate votes, run as a user runs it.
#include <string>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kVotesHead = "voter,kind,subject,first,second,choice\r\n";

TEST_F(Cli, MethodsAreRankedByVotesOfSeveralFiles) {
  put("anna.csv", kVotesHead + "anna,rig,fox,own + bone-heat,prop + bone-heat,first\r\n");
  put("ben.csv", kVotesHead + "ben,rig,fox,prop + bone-heat,own + bone-heat,second\r\nben,rig,hen,a,b,alike\r\n");
  const Result table = run({"evaluate", "votes", "anna.csv", "ben.csv"});
  EXPECT_EQ(table.code, 0) << table.error;
  EXPECT_THAT(table.out, AllOf(HasSubstr("rig: 3 votes of 2 voters"), HasSubstr("| own + bone-heat | 2 | 100.0 % |"),
                               HasSubstr("| own + bone-heat | prop + bone-heat | 2 | 0 | 0 |")));
  // The same file twice is the same votes.
  EXPECT_EQ(run({"evaluate", "votes", "anna.csv", "ben.csv", "ben.csv"}).out, table.out);
  const Result json = run({"evaluate", "votes", "anna.csv", "--json"});
  EXPECT_THAT(json.out, AllOf(HasSubstr("\"kind\": \"rig\""), HasSubstr("\"strength_low\"")));
  EXPECT_EQ(run({"evaluate", "votes", "anna.csv", "ben.csv", "-o", "ranking.md"}).code, 0);
  EXPECT_EQ(content("ranking.md"), table.out);
}

TEST_F(Cli, BadVotesAreOneErrorWithTheirLine) {
  put("bad.csv", kVotesHead + "anna,rig,fox,a,b,first\r\nanna,rig,fox,a,b,left\r\n");
  const Result bad = run({"evaluate", "votes", "bad.csv", "-o", "ranking.md"});
  expectOneLine(bad, 1);
  EXPECT_THAT(bad.error, HasSubstr("bad.csv: line 3: \"left\" is no choice"));
  EXPECT_FALSE(fs::exists(folder_ / "ranking.md"));
  put("none.csv", kVotesHead);
  expectOneLine(run({"evaluate", "votes", "none.csv"}), 1);
  expectOneLine(run({"evaluate", "votes", "missing.csv"}), 1);
  // A study refuses them before it runs anything.
  put("plan.json", R"({"limber_study": 1, "rig": {"models": ["sample:stool"], "riggers": ["prop"]}})");
  expectOneLine(run({"study", "plan.json", "-o", "report", "--votes", "bad.csv"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "report"));
}

}  // namespace
}  // namespace limber
