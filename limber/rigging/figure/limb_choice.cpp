#include "limber/rigging/figure/limb_choice.h"

#include "limber/rigging/figure/limb_overlap.h"

namespace limber {

namespace {

using Choice = std::array<std::size_t, kFigureLimbs>;

constexpr int kPairs[][2] = {{0, 1}, {2, 3}, {0, 2}, {0, 3}, {1, 2}, {1, 3}};
constexpr int kChoiceRounds = 3;

class Matches {
 public:
  Matches(const Figure& figure, const LimbCandidates& candidates) : candidates_(candidates) {
    std::array<std::vector<LimbSpace>, kFigureLimbs> spaces;
    Figure trial = figure;
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      for (const LimbFinder::Candidate& candidate : candidates[limb]) {
        trial.limbs[limb] = candidate.bones;
        spaces[limb].push_back(spaceOf(trial, limb));
      }
    }
    for (int a = 0; a < kFigureLimbs; ++a) {
      for (int b = a + 1; b < kFigureLimbs; ++b) {
        for (const LimbSpace& first : spaces[a]) {
          for (const LimbSpace& second : spaces[b]) costs_[a][b].push_back(sharingCost(limbOverlap(first, second)));
        }
      }
    }
  }

  double of(const Choice& choice) const {
    double sum = 0;
    for (int a = 0; a < kFigureLimbs; ++a) {
      sum += candidates_[a][choice[a]].match;
      for (int b = a + 1; b < kFigureLimbs; ++b) sum -= costs_[a][b][choice[a] * candidates_[b].size() + choice[b]];
    }
    return sum;
  }

 private:
  const LimbCandidates& candidates_;
  std::vector<double> costs_[kFigureLimbs][kFigureLimbs];  // row by row, a candidate of the first limb each
};

}  // namespace

Choice chooseLimbs(const Figure& figure, const LimbCandidates& candidates) {
  const Matches matches(figure, candidates);
  Choice best = {};
  double most = matches.of(best);
  for (int round = 0; round < kChoiceRounds; ++round) {
    const double before = most;
    for (const auto& [a, b] : kPairs) {
      Choice trial = best;
      for (trial[a] = 0; trial[a] < candidates[a].size(); ++trial[a]) {
        for (trial[b] = 0; trial[b] < candidates[b].size(); ++trial[b]) {
          const double match = matches.of(trial);
          if (match <= most) continue;
          most = match;
          best = trial;
        }
      }
    }
    if (most <= before) break;
  }
  return best;
}

}  // namespace limber
