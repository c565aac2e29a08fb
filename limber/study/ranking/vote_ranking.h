// Methods ranked by what people chose.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/study/ranking/ballot.h"
#include "limber/study/ranking/method_ranking.h"

namespace limber {

struct VoteScore {
  std::string method;
  std::size_t votes = 0;  // that it was part of
  double chosen = 0;      // fraction of these, 0 to 1; "alike" is half a vote for each
  // The chance, 0 to 1, that it is chosen beside a method of middling strength (bradleyTerryStrengths: s / (s + 1));
  // the mean over all methods is 1/2. Low and high: 95 % of 2000 samples of the votes, drawn with replacement
  // (percentile bootstrap, seed 1).
  double strength = 0, low = 0, high = 0;
};

struct VoteRanking {
  CellKind kind = CellKind::kRig;
  std::size_t votes = 0, voters = 0;
  std::vector<VoteScore> scores;  // strongest first, alike ones by name
  // The first is the one that ranks higher; p: signed rank test of the votes that chose one (which is the sign test),
  // corrected for all pairs. Those that were never compared are left out.
  std::vector<MethodPair> pairs;
};

// Of each kind that has votes; each vote counts as given. Does not depend on their order. Throws Error
// kLimit above 1000 methods.
std::vector<VoteRanking> rankByVotes(std::span<const Vote> votes);

// For each kind the ranking, and what was chosen of each two.
std::vector<Table> voteTables(std::span<const VoteRanking> rankings);
Json toJson(std::span<const VoteRanking> rankings);

}  // namespace limber
