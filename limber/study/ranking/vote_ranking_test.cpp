#include "limber/study/ranking/vote_ranking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/random.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kNames = {"ant", "bee", "cat", "dog"};

// Voters who choose between each two as their strengths have it, "alike" one time in ten; sides change.
std::vector<Vote> drawnVotes(std::span<const double> strengths, int rounds, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vote> votes;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < strengths.size(); ++i) {
      for (std::size_t j = 0; j < strengths.size(); ++j) {
        if (i == j) continue;
        const double luck = random.uniform();
        const bool isAlike = random.uniform() < 0.1;
        const bool firstWins = luck < strengths[i] / (strengths[i] + strengths[j]);
        votes.push_back({"voter " + std::to_string(round % 3), CellKind::kRig, "fox " + std::to_string(round),
                         kNames[i], kNames[j],
                         isAlike     ? Choice::kAlike
                         : firstWins ? Choice::kFirst
                                     : Choice::kSecond});
      }
    }
  }
  return votes;
}

Vote vote(const std::string& first, const std::string& second, Choice choice, CellKind kind = CellKind::kRig) {
  return {"anna", kind, "fox", first, second, choice};
}

TEST(VoteRanking, FindsTheStrengthsThatVotesWereDrawnFrom) {
  const std::vector<double> strengths = {1, 4, 0.5, 2};
  const std::vector<VoteRanking> rankings = rankByVotes(drawnVotes(strengths, 120, 5));
  ASSERT_EQ(rankings.size(), 1u);
  const VoteRanking& ranking = rankings[0];
  EXPECT_EQ(ranking.votes, 120u * 12);
  EXPECT_EQ(ranking.voters, 3u);
  std::vector<std::string> order;
  for (const VoteScore& score : ranking.scores) order.push_back(score.method);
  EXPECT_EQ(order, (std::vector<std::string>{"bee", "dog", "ant", "cat"}));
  for (const VoteScore& score : ranking.scores) {
    EXPECT_LT(score.low, score.strength);
    EXPECT_GT(score.high, score.strength);
  }
  // Ties draw together, and the prior a little: by a tenth of the logarithm each at most.
  const auto logOdds = [](const VoteScore& score) { return std::log(score.strength / (1 - score.strength)); };
  EXPECT_NEAR(logOdds(ranking.scores[0]) - logOdds(ranking.scores[3]), std::log(8.0), 0.2 * std::log(8.0));
  for (const MethodPair& pair : ranking.pairs) EXPECT_LT(pair.p, 0.05) << pair.first << " " << pair.second;
  EXPECT_EQ(ranking.pairs.size(), 6u);
}

// Of 40 draws, at least nine in ten intervals hold the expected chance of it.
TEST(VoteRanking, IntervalsHoldTheTruthAboutAsOftenAsTheySay) {
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::vector<VoteRanking> rankings = rankByVotes(drawnVotes(std::vector<double>{1, 1, 1, 1}, 5, seed));
    for (const VoteScore& score : rankings[0].scores) {
      covered += score.low <= 0.5 && 0.5 <= score.high ? 1 : 0;
    }
  }
  EXPECT_GE(covered, 144);
  EXPECT_LT(covered, 160);
}

TEST(VoteRanking, ATieIsHalfAVoteOfEach) {
  const std::vector<Vote> votes = {vote("ant", "bee", Choice::kAlike), vote("bee", "ant", Choice::kAlike),
                                   vote("ant", "bee", Choice::kFirst), vote("bee", "ant", Choice::kSecond)};
  const VoteRanking ranking = rankByVotes(votes)[0];
  EXPECT_EQ(ranking.scores[0].method, "ant");
  EXPECT_EQ(ranking.scores[0].votes, 4u);
  EXPECT_EQ(ranking.scores[0].chosen, 0.75);
  EXPECT_EQ(ranking.scores[1].chosen, 0.25);
  ASSERT_EQ(ranking.pairs.size(), 1u);
  EXPECT_EQ(ranking.pairs[0].firstWins, 2u);
  EXPECT_EQ(ranking.pairs[0].secondWins, 0u);
  EXPECT_EQ(ranking.pairs[0].ties, 2u);
  EXPECT_EQ(ranking.pairs[0].p, 0.5);  // two of two to one side
}

TEST(VoteRanking, NeitherOrderNorSidesMatter) {
  std::vector<Vote> votes = drawnVotes(std::vector<double>{1, 3, 2}, 10, 2);
  const std::string before = toMarkdown(voteTables(rankByVotes(votes)));
  std::reverse(votes.begin(), votes.end());
  for (std::size_t i = 0; i < votes.size(); i += 2) {
    std::swap(votes[i].first, votes[i].second);
    if (votes[i].choice != Choice::kAlike)
      votes[i].choice = votes[i].choice == Choice::kFirst ? Choice::kSecond : Choice::kFirst;
  }
  EXPECT_EQ(toMarkdown(voteTables(rankByVotes(votes))), before);
}

TEST(VoteRanking, AMethodThatWonAllAndOneThatWasNeverComparedWithItHavePlaces) {
  const std::vector<Vote> votes = {vote("ant", "bee", Choice::kFirst), vote("ant", "bee", Choice::kFirst),
                                   vote("cat", "dog", Choice::kFirst)};
  const VoteRanking ranking = rankByVotes(votes)[0];
  ASSERT_EQ(ranking.scores.size(), 4u);
  EXPECT_EQ(ranking.scores[0].method, "ant");
  EXPECT_EQ(ranking.scores[1].method, "cat");
  EXPECT_LT(ranking.scores[0].strength, 1);
  EXPECT_EQ(ranking.scores[3].method, "bee");
  EXPECT_EQ(ranking.pairs.size(), 2u);
}

TEST(VoteRanking, KindsAreApartAndNoVotesAreNoRanking) {
  EXPECT_TRUE(rankByVotes({}).empty());
  const std::vector<Vote> votes = {vote("copy", "limb-ik", Choice::kSecond, CellKind::kRetarget),
                                   vote("ant", "bee", Choice::kFirst)};
  const std::vector<VoteRanking> rankings = rankByVotes(votes);
  ASSERT_EQ(rankings.size(), 2u);
  EXPECT_EQ(rankings[0].kind, CellKind::kRig);
  EXPECT_EQ(rankings[1].scores[0].method, "limb-ik");
  EXPECT_EQ(rankings[1].scores.size(), 2u);
}

TEST(VoteRanking, TablesCannotBeBrokenByNames) {
  const std::vector<VoteRanking> rankings = rankByVotes(std::vector{vote("a|b\n# c", "<script>", Choice::kFirst)});
  EXPECT_THAT(toMarkdown(voteTables(rankings)),
              AllOf(HasSubstr("| a\\|b \\# c | 1 | 100.0 % |"), HasSubstr("\\<script\\>"),
                    HasSubstr("rig: 1 vote of 1 voter"), Not(HasSubstr("\n# c"))));
  const Json json = toJson(rankings);
  EXPECT_EQ(json["rankings"][0]["methods"][0]["method"], "a|b\n# c");
  EXPECT_EQ(json["rankings"][0]["pairs"][0]["first_chosen"], 1);
}

TEST(VoteRanking, RefusesMoreMethodsThanAnyoneVotesOn) {
  std::vector<Vote> votes;
  for (int i = 0; i < 1000; ++i) votes.push_back(vote("a", "b" + std::to_string(i), Choice::kFirst));
  EXPECT_THROW(rankByVotes(votes), Error);
}

}  // namespace
}  // namespace limber
