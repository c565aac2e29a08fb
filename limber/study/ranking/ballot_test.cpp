#include "limber/study/ranking/ballot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kHead = "voter,kind,subject,first,second,choice\r\n";

std::string problemOf(const std::string& text) {
  try {
    parseVotes(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    return error.what();
  }
  return "read without an error";
}

Vote voteOf(const std::string& voter, const std::string& first, const std::string& second, Choice choice) {
  return {voter, CellKind::kRig, "fox", first, second, choice};
}

TEST(Ballot, ReadsVotes) {
  const std::vector<Vote> votes = parseVotes(kHead +
                                             "anna,rig,fox,a + b,c + b,first\r\n"
                                             "\r\n"
                                             "ben,retarget,\"fox, walk\",copy,\"limb \"\"ik\"\"\r\nnew\",alike\r\n"
                                             "ben,rig,fox,a,c,second");
  ASSERT_EQ(votes.size(), 3u);
  EXPECT_EQ(votes[0].voter, "anna");
  EXPECT_EQ(votes[0].kind, CellKind::kRig);
  EXPECT_EQ(votes[0].first, "a + b");
  EXPECT_EQ(votes[0].choice, Choice::kFirst);
  EXPECT_EQ(votes[1].kind, CellKind::kRetarget);
  EXPECT_EQ(votes[1].subject, "fox, walk");
  EXPECT_EQ(votes[1].second, "limb \"ik\"\r\nnew");
  EXPECT_EQ(votes[1].choice, Choice::kAlike);
  EXPECT_EQ(votes[2].choice, Choice::kSecond);
}

TEST(Ballot, ColumnsStandInAnyOrderAmongOthers) {
  const std::vector<Vote> votes = parseVotes(
      "\xef\xbb\xbf"
      "choice,second,first,note,subject,kind,voter\nfirst,b,a,well,fox,rig,anna\n");
  ASSERT_EQ(votes.size(), 1u);
  EXPECT_EQ(votes[0].voter, "anna");
  EXPECT_EQ(votes[0].first, "a");
  EXPECT_EQ(votes[0].choice, Choice::kFirst);
}

TEST(Ballot, SaysWhichLineIsBad) {
  const std::string good = "anna,rig,fox,a,b,first\r\n";
  const std::pair<std::string, std::string> cases[] = {
      {"", "line 1"},
      {"voter,kind\n", "line 1"},
      {kHead + good + "anna,rig,fox,a,b\n", "line 3: has 5 fields in place of 6"},
      {kHead + good + "anna,rig,fox,a,b,first,more\n", "line 3: has 7 fields"},
      {kHead + good + good + "anna,rigs,fox,a,b,first\n", "line 4: \"rigs\" is no kind"},
      {kHead + "anna,rig,fox,a,b,left\n", "line 2: \"left\" is no choice"},
      {kHead + "anna,rig,fox,,b,first\n", "line 2: a method has no name"},
      {kHead + "anna,rig,fox,a,a,first\n", "line 2: a method is compared with itself"},
      {kHead + "anna,rig,\"fo\nx\",a,b,first\nanna,rig,fox,a\"b,b,first\n", "line 4: a quotation mark"},
      {kHead + good + "anna,rig,\"fox,a,b,first\n\n\n", "line 3: a field's quotation mark is not closed"},
      {kHead + "anna,rig,\"fox\"es,a,b,first\n", "line 2: a field goes on after its quotation mark"},
  };
  for (const auto& [text, problem] : cases) EXPECT_THAT(problemOf(text), HasSubstr(problem)) << text;
}

// Votes that hold what they promise, or an error that names a line.
void expectReadOrRefused(const std::string& text) {
  try {
    for (const Vote& vote : parseVotes(text)) {
      EXPECT_FALSE(vote.first.empty()) << text;
      EXPECT_NE(vote.first, vote.second) << text;
    }
  } catch (const Error& error) {
    EXPECT_THAT(error.where(), HasSubstr("line ")) << text;
  }
}

TEST(Ballot, ATextCutOrDamagedAnywhereIsReadOrRefused) {
  const std::string text = kHead + "anna,rig,\"fox, \"\"red\"\"\",a,b,first\r\nben,rig,fox,a,b,alike\r\n";
  for (std::size_t at = 0; at < text.size(); ++at) {
    expectReadOrRefused(text.substr(0, at));
    for (const char damage : {'"', ',', '\r', '\n', '\0', '\xff', 'a'}) {
      std::string damaged = text;
      damaged[at] = damage;
      expectReadOrRefused(damaged);
      expectReadOrRefused(text.substr(0, at) + damage + text.substr(at));
    }
  }
}

TEST(Ballot, TheLastVoteOnTheSameTwoResultsCounts) {
  const std::vector<Vote> votes = {voteOf("anna", "a", "b", Choice::kFirst), voteOf("ben", "a", "b", Choice::kFirst),
                                   voteOf("anna", "a", "c", Choice::kAlike), voteOf("anna", "b", "a", Choice::kFirst)};
  const std::vector<Vote> last = lastVotes(votes);
  ASSERT_EQ(last.size(), 3u);
  EXPECT_EQ(last[0].first, "b");
  EXPECT_EQ(last[1].voter, "ben");
  EXPECT_EQ(last[2].second, "c");
  std::vector<Vote> twice = votes;
  twice.insert(twice.end(), votes.begin(), votes.end());
  EXPECT_EQ(lastVotes(twice).size(), 3u);
}

TEST(Ballot, KeepsVotesOnResultsThatTheStudyHas) {
  std::vector<StudyCell> cells(3);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].model = "fox";
    cells[i].rigger = std::string(1, static_cast<char>('a' + i));
    cells[i].skinning = "w";
  }
  cells[2].model = "hen";
  const std::vector<Vote> votes = {voteOf("anna", "a + w", "b + w", Choice::kFirst),
                                   voteOf("anna", "a + w", "c + w", Choice::kFirst),
                                   {"anna", CellKind::kRetarget, "fox", "a + w", "b + w", Choice::kFirst}};
  const std::vector<Vote> kept = votesOn(cells, votes);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].second, "b + w");
}

}  // namespace
}  // namespace limber
