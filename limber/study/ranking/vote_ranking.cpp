#include "limber/study/ranking/vote_ranking.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/counted.h"
#include "limber/core/error.h"
#include "limber/core/random.h"
#include "limber/study/ranking/bradley_terry.h"
#include "limber/study/ranking/paired_statistics.h"

namespace limber {

namespace {

constexpr int kVoteSamples = 2000;
constexpr std::size_t kMaxMethods = 1000;  // samples x methods are kept at once

// The votes of a kind: methods by name, each two that were compared, and the votes as numbers, sorted.
struct Games {
  struct Vote {
    std::size_t pair = 0;
    Choice choice = Choice::kAlike;
    auto operator<=>(const Vote&) const = default;
  };

  std::vector<std::string> methods;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // of methods, the lower first
  std::vector<Vote> votes;
};

Choice swapped(Choice choice) {
  if (choice == Choice::kAlike) return choice;
  return choice == Choice::kFirst ? Choice::kSecond : Choice::kFirst;
}

Games gamesOf(std::span<const Vote> votes, CellKind kind) {
  std::set<std::string> names;
  std::set<std::pair<std::string, std::string>> compared;
  for (const Vote& vote : votes) {
    if (vote.kind != kind) continue;
    names.insert({vote.first, vote.second});
    compared.insert(std::minmax(vote.first, vote.second));
  }
  Games games;
  games.methods.assign(names.begin(), names.end());
  const auto numberOf = [&](const std::string& name) {
    return static_cast<std::size_t>(std::lower_bound(games.methods.begin(), games.methods.end(), name) -
                                    games.methods.begin());
  };
  for (const auto& [first, second] : compared) games.pairs.emplace_back(numberOf(first), numberOf(second));
  for (const Vote& vote : votes) {
    if (vote.kind != kind) continue;
    const std::pair<std::size_t, std::size_t> pair = std::minmax({numberOf(vote.first), numberOf(vote.second)});
    const auto at = std::lower_bound(games.pairs.begin(), games.pairs.end(), pair);
    games.votes.push_back({static_cast<std::size_t>(at - games.pairs.begin()),
                           vote.first < vote.second ? vote.choice : swapped(vote.choice)});
  }
  std::sort(games.votes.begin(), games.votes.end());
  return games;
}

std::vector<PairScore> emptyScores(const Games& games) {
  std::vector<PairScore> scores;
  for (const auto& [first, second] : games.pairs) scores.push_back({first, second});
  return scores;
}

void count(const Games::Vote& vote, std::span<PairScore> scores) {
  PairScore& score = scores[vote.pair];
  const double firstWins = vote.choice == Choice::kFirst ? 1 : vote.choice == Choice::kAlike ? 0.5 : 0;
  score.firstWins += firstWins;
  score.secondWins += 1 - firstWins;
}

// The chances against a method of middling strength.
std::vector<double> chancesOf(const Games& games, std::span<const PairScore> scores) {
  std::vector<double> chances = bradleyTerryStrengths(games.methods.size(), scores);
  for (double& strength : chances) strength /= strength + 1;
  return chances;
}

void addIntervals(const Games& games, std::span<VoteScore> scores) {
  Random random(1);
  std::vector<std::vector<double>> drawn(scores.size());
  for (int sample = 0; sample < kVoteSamples; ++sample) {
    std::vector<PairScore> pairs = emptyScores(games);
    for (std::size_t i = 0; i < games.votes.size(); ++i) count(games.votes[random.below(games.votes.size())], pairs);
    const std::vector<double> chances = chancesOf(games, pairs);
    for (std::size_t m = 0; m < chances.size(); ++m) drawn[m].push_back(chances[m]);
  }
  for (std::size_t m = 0; m < scores.size(); ++m) {
    const auto [low, high] = percentileInterval(std::move(drawn[m]));
    scores[m].low = low;
    scores[m].high = high;
  }
}

std::vector<VoteScore> scoresOf(const Games& games) {
  std::vector<PairScore> pairs = emptyScores(games);
  for (const Games::Vote& vote : games.votes) count(vote, pairs);
  std::vector<VoteScore> scores(games.methods.size());
  std::vector<double> wins(scores.size()), all(scores.size());
  for (const PairScore& pair : pairs) {
    wins[pair.first] += pair.firstWins;
    wins[pair.second] += pair.secondWins;
    for (const std::size_t m : {pair.first, pair.second}) all[m] += pair.firstWins + pair.secondWins;
  }
  const std::vector<double> chances = chancesOf(games, pairs);
  for (std::size_t m = 0; m < scores.size(); ++m) {
    scores[m].method = games.methods[m];
    scores[m].votes = static_cast<std::size_t>(all[m]);
    scores[m].chosen = wins[m] / all[m];
    scores[m].strength = chances[m];
  }
  addIntervals(games, scores);
  return scores;
}

MethodPair pairOfVotes(const Games& games, std::size_t pair, bool isTurned) {
  const auto begin = std::partition_point(games.votes.begin(), games.votes.end(),
                                          [&](const Games::Vote& vote) { return vote.pair < pair; });
  const auto end =
      std::partition_point(begin, games.votes.end(), [&](const Games::Vote& vote) { return vote.pair == pair; });
  std::vector<double> differences;
  MethodPair result;
  for (const Games::Vote& vote : std::span(begin, end)) {
    const Choice choice = isTurned ? swapped(vote.choice) : vote.choice;
    (choice == Choice::kFirst ? result.firstWins : choice == Choice::kSecond ? result.secondWins : result.ties) += 1;
    if (choice != Choice::kAlike) differences.push_back(choice == Choice::kFirst ? 1 : -1);
  }
  result.p = signedRankP(differences);
  return result;
}

// In the order of the ranking. `indices`: the index in the ranking of each method, by number.
std::vector<MethodPair> pairsOf(const Games& games, std::span<const std::size_t> indices) {
  std::vector<std::tuple<std::size_t, std::size_t, MethodPair>> found;
  for (std::size_t i = 0; i < games.pairs.size(); ++i) {
    auto [first, second] = games.pairs[i];
    const bool isTurned = indices[first] > indices[second];
    if (isTurned) std::swap(first, second);
    MethodPair pair = pairOfVotes(games, i, isTurned);
    pair.first = games.methods[first];
    pair.second = games.methods[second];
    found.emplace_back(indices[first], indices[second], std::move(pair));
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
  });
  std::vector<MethodPair> pairs;
  for (auto& one : found) pairs.push_back(std::move(std::get<2>(one)));
  correctForAll(pairs);
  return pairs;
}

VoteRanking rankingOf(std::span<const Vote> votes, CellKind kind) {
  VoteRanking ranking;
  ranking.kind = kind;
  std::set<std::string> voters;
  for (const Vote& vote : votes) {
    if (vote.kind == kind) voters.insert(vote.voter);
  }
  ranking.voters = voters.size();
  const Games games = gamesOf(votes, kind);
  if (games.methods.size() > kMaxMethods) {
    throw Error(ErrorCode::kLimit,
                fmt::format("votes on {} methods are more than {}", games.methods.size(), kMaxMethods));
  }
  ranking.votes = games.votes.size();
  const std::vector<VoteScore> scores = scoresOf(games);
  std::vector<std::size_t> order(scores.size()), indices(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a].strength > scores[b].strength; });
  for (std::size_t index = 0; index < order.size(); ++index) {
    indices[order[index]] = index;
    ranking.scores.push_back(scores[order[index]]);
  }
  ranking.pairs = pairsOf(games, indices);
  return ranking;
}

}  // namespace

std::vector<VoteRanking> rankByVotes(std::span<const Vote> votes) {
  std::vector<VoteRanking> rankings;
  for (const CellKind kind : {CellKind::kRig, CellKind::kRetarget}) {
    if (std::any_of(votes.begin(), votes.end(), [&](const Vote& vote) { return vote.kind == kind; }))
      rankings.push_back(rankingOf(votes, kind));
  }
  return rankings;
}

std::vector<Table> voteTables(std::span<const VoteRanking> rankings) {
  std::vector<Table> tables;
  for (const VoteRanking& ranking : rankings) {
    Table& table =
        tables.emplace_back(Table{{words("method"), number("votes", 0), number("chosen", 1, " %"),
                                   number("strength", 1, " %"), number("95 % interval", 1)},
                                  fmt::format("{}: {} of {}", cellKindName(ranking.kind),
                                              counted(ranking.votes, "vote"), counted(ranking.voters, "voter"))});
    for (const VoteScore& score : ranking.scores) {
      table.add({foreign(score.method), score.votes, 100 * score.chosen, 100 * score.strength,
                 fmt::format("{:.1f} to {:.1f}", 100 * score.low, 100 * score.high)});
    }
    tables.push_back(pairTable(ranking.pairs, "alike"));
  }
  return tables;
}

Json toJson(std::span<const VoteRanking> rankings) {
  Json all = Json::array();
  for (const VoteRanking& ranking : rankings) {
    Json methods = Json::array(), pairs = Json::array();
    for (const VoteScore& score : ranking.scores) {
      methods.push_back({{"method", score.method},
                         {"votes", score.votes},
                         {"chosen", score.chosen},
                         {"strength", score.strength},
                         {"strength_low", score.low},
                         {"strength_high", score.high}});
    }
    for (const MethodPair& pair : ranking.pairs) {
      pairs.push_back({{"first", pair.first},
                       {"second", pair.second},
                       {"first_chosen", pair.firstWins},
                       {"second_chosen", pair.secondWins},
                       {"alike", pair.ties},
                       {"p", pair.p}});
    }
    all.push_back({{"kind", cellKindName(ranking.kind)},
                   {"votes", ranking.votes},
                   {"voters", ranking.voters},
                   {"methods", std::move(methods)},
                   {"pairs", std::move(pairs)}});
  }
  return {{"rankings", std::move(all)}};
}

}  // namespace limber
