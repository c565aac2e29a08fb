#include "limber/rigging/figure/figure_search.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "limber/core/parallel.h"
#include "limber/rigging/body/plinth.h"
#include "limber/rigging/figure/best_apart.h"
#include "limber/rigging/figure/figure_steps.h"
#include "limber/rigging/figure/limb_choice.h"
#include "limber/rigging/figure/limb_finder.h"
#include "limber/rigging/figure/steady.h"
#include "limber/rigging/figure/trunk_search.h"

namespace limber {

namespace {

constexpr double kMinHead = 0.45;    // match of a head below which there is none
constexpr std::size_t kChests = 80;  // that hang from a head of one stature
constexpr std::size_t kTrunks = 800, kKept = 24, kImproved = 8;
constexpr int kRounds = 2;  // of limbs found anew and improved
constexpr int kFirstSteps = 1200, kSteps = 1500, kLimbSteps = 120;
constexpr std::size_t kReconsidered = 4;
constexpr std::size_t kPolished = 4;
constexpr int kPolishSteps = 3000;
constexpr int kReconsiderRounds = 2, kFirstReconsiderSteps = 100, kReconsiderSteps = 300;
constexpr double kHopeless = 0.4;        // less than the best so far after the first of these steps
constexpr double kWorthImproving = 0.7;  // less than the best candidate of a limb, at most
constexpr LimbFinder::Effort kQuick = {24, 6, false}, kThorough = {80, 18, true};
constexpr std::size_t kTriedLimbs = 8;
constexpr double kLikeStature = 0.125;  // ratio of statures that one finder of limbs serves
constexpr double kAlike = 0.08;         // statures between elbows, knees, wrists and ankles
constexpr double kAlikeMiddle = 0.04, kAlikeAnkle = 0.05;

constexpr double kMaxGain = 0.15;  // of a limb by one step of the trunk
constexpr double kNobody = -1e9;   // total of a trunk without limbs

using Candidates = std::vector<LimbFinder::Candidate>;

bool better(const MatchedFigure& a, const MatchedFigure& b) {
  return a.total > b.total;
}

class Search {
 public:
  Search(const BodyVolume& body, const FigureMatch& match, const FigureSearch& options, Progress& progress)
      : body_(body), match_(match), options_(options), progress_(progress) {}

  std::optional<MatchedFigure> run() {
    std::vector<HeadBall> heads = findHeads(body_, match_, options_.up);
    std::erase_if(heads, [](const HeadBall& head) { return head.match < kMinHead; });
    figures_ = trunks(heads);
    if (figures_.empty()) return {};
    progress_.update(0.1);
    parallelFor(figures_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) holdLimbs(figures_[i], kQuick, nullptr);
    });
    keepApart(figures_, kKept);
    forEach(0.3, [&](MatchedFigure& figure, Random& random) { improve(figure, kFirstSteps, random); });
    keepApart(figures_, kImproved);
    forEach(0.6, [&](MatchedFigure& figure, Random& random) {
      for (int round = 0; round < kRounds; ++round) {
        MatchedFigure other = figure;
        holdLimbs(other, kThorough, &random);
        improve(other, kSteps, random);
        if (better(other, figure)) figure = other;
      }
    });
    keepApart(figures_, kReconsidered);
    forEach(0.8, [&](MatchedFigure& figure, Random& random) { reconsider(figure, random); });
    if (figures_.front().total <= kNobody) return {};
    // The best once more, each time by other steps; and facing backwards, which only the feet may distinguish.
    const MatchedFigure best = figures_.front();
    figures_.assign(kPolished, best);
    const Figure around = turnedAround(best.figure);
    if (allowed(around)) std::fill_n(figures_.begin(), kPolished / 2, matched(match_, around));
    forEach(1, [&](MatchedFigure& figure, Random& random) {
      improve(figure, kPolishSteps, random);
      reconsider(figure, random);
    });
    return figures_.front();
  }

 private:
  // Changes every figure, the best come first after it.
  //
  // fraction  of the whole search that is done then
  template <class Change>
  void forEach(double fraction, const Change& change) {
    parallelFor(figures_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !progress_.cancelled(); ++i) {
        Random random(i);
        change(figures_[i], random);
      }
    });
    std::stable_sort(figures_.begin(), figures_.end(), better);
    progress_.update(fraction);
  }

  bool facesRight(const Figure& figure) const {
    return !options_.front || options_.front->dot(figure.chest.col(2) + figure.pelvis.col(2)) > 0;
  }

  bool allowed(const Figure& figure) const {
    bool every = facesRight(figure);
    for (int limb = 0; limb < kFigureLimbs; ++limb) every = every && limbAllowed(figure, limb);
    return every;
  }

  std::vector<MatchedFigure> trunks(const std::vector<HeadBall>& heads) {
    std::vector<std::pair<const HeadBall*, double>> starts;
    for (const HeadBall& head : heads) {
      for (const double stature : staturesFor(head)) starts.emplace_back(&head, stature);
    }
    std::vector<std::vector<MatchedFigure>> found(starts.size());
    parallelFor(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        found[i] = findTrunks(body_, match_, *starts[i].first, starts[i].second, options_.up, kChests);
      }
    });
    std::vector<MatchedFigure> trunks;
    for (const std::vector<MatchedFigure>& some : found) trunks.insert(trunks.end(), some.begin(), some.end());
    std::erase_if(trunks, [&](const MatchedFigure& trunk) { return !facesRight(trunk.figure); });
    std::stable_sort(trunks.begin(), trunks.end(), better);
    if (trunks.size() > kTrunks) trunks.resize(kTrunks);
    for (const auto& [head, stature] : starts) {
      const auto has = [size = stature](const MatchedFigure& trunk) { return trunk.figure.stature == size; };
      const auto serves = [size = stature](const auto& finder) {
        return std::abs(ratioOff(finder->stature() / size)) < kLikeStature;
      };
      if (std::any_of(trunks.begin(), trunks.end(), has) && std::none_of(finders_.begin(), finders_.end(), serves)) {
        finders_.push_back(std::make_unique<LimbFinder>(body_, match_, stature));
      }
    }
    return trunks;
  }

  const LimbFinder& finderFor(double stature) const {
    const auto off = [&](const auto& finder) { return std::abs(ratioOff(finder->stature() / stature)); };
    return **std::min_element(finders_.begin(), finders_.end(),
                              [&](const auto& a, const auto& b) { return off(a) < off(b); });
  }

  // Finds limbs for a trunk, those that go best together. With `random`, each is improved for itself first.
  void holdLimbs(MatchedFigure& figure, const LimbFinder::Effort& effort, Random* random) const {
    LimbCandidates candidates;
    const LimbFinder& finder = finderFor(figure.figure.stature);
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      candidates[limb] = finder.find(figure.figure, limb, effort);
      if (candidates[limb].empty()) {
        figure.total = kNobody;
        return;
      }
      if (random) improveEach(figure.figure, limb, candidates[limb], *random);
    }
    figure.trunk = match_.trunk(figure.figure);
    const std::array<std::size_t, kFigureLimbs> choice = chooseLimbs(figure.figure, candidates);
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      figure.figure.limbs[limb] = candidates[limb][choice[limb]].bones;
      figure.limbs[limb] = candidates[limb][choice[limb]].match;
    }
    sumUp(figure);
  }

  // Those far worse than the best are left out.
  void improveEach(const Figure& figure, int limb, Candidates& candidates, Random& random) const {
    Figure trial = figure;
    const auto isTooBad =
        [most = candidates.empty() ? 0 : candidates.front().match](const LimbFinder::Candidate& candidate) {
          return candidate.match < most - kWorthImproving;
        };
    std::erase_if(candidates, isTooBad);
    for (LimbFinder::Candidate& candidate : candidates) {
      StepSize size(25, 0.6);
      for (int step = 0; step < kLimbSteps; ++step) {
        trial.limbs[limb] = candidate.bones;
        stepLimb(trial, limb, size.value(), random);
        const double match = limbAllowed(trial, limb) ? match_.limb(trial, limb) : -1e9;
        if (match > candidate.match) {
          candidate = {trial.limbs[limb], match};
          size.succeeded();
        } else if (!size.failed()) {
          break;
        }
      }
    }
    const auto positionsOf = [&](const LimbFinder::Candidate& candidate) {
      trial.limbs[limb] = candidate.bones;
      return trial.positions(limb);
    };
    candidates = bestApart(
        std::move(candidates), kTriedLimbs, [](const LimbFinder::Candidate& candidate) { return candidate.match; },
        [&](const LimbFinder::Candidate& a, const LimbFinder::Candidate& b) {
          return alike(positionsOf(a), positionsOf(b), kAlikeMiddle * figure.stature, kAlikeAnkle * figure.stature);
        });
  }

  // Tries other poses of each limb, with the whole figure improved for each: a trunk fits the limbs it was found with
  // better than any others.
  void reconsider(MatchedFigure& figure, Random& random) const {
    for (int round = 0; round < kReconsiderRounds; ++round) {
      const double before = figure.total;
      for (int limb = 0; limb < kFigureLimbs; ++limb) {
        Candidates candidates = finderFor(figure.figure.stature).find(figure.figure, limb, kThorough);
        improveEach(figure.figure, limb, candidates, random);
        MatchedFigure best = figure;
        for (const LimbFinder::Candidate& candidate : candidates) {
          MatchedFigure trial = figure;
          trial.figure.limbs[limb] = candidate.bones;
          trial.limbs[limb] = candidate.match;
          sumUp(trial);
          improve(trial, kFirstReconsiderSteps, random);
          if (trial.total > figure.total - kHopeless) improve(trial, kReconsiderSteps, random);
          if (better(trial, best)) best = trial;
        }
        figure = best;
      }
      if (figure.total <= before) return;
    }
  }

  // Small random steps of the whole figure, as long as they are for the better.
  void improve(MatchedFigure& figure, int steps, Random& random) const {
    if (figure.total <= kNobody) return;
    StepSize size(120, 0.7);
    for (int step = 0; step < steps; ++step) {
      MatchedFigure trial = figure;
      const int part = static_cast<int>(random.below(9)) - 5;
      bool isBetter = false;
      if (part < 0) {
        stepTrunk(trial.figure, size.value(), random);
        if (!allowed(trial.figure)) continue;
        isBetter = trunkImproves(trial, figure);
      } else {
        stepLimb(trial.figure, part, size.value(), random);
        if (!limbAllowed(trial.figure, part)) continue;
        trial.limbs[part] = match_.limb(trial.figure, part);
        isBetter = sumImproves(trial, figure);
      }
      if (isBetter) {
        figure = trial;
        size.succeeded();
      } else if (!size.failed()) {
        return;
      }
    }
  }

  // Matches the parts of `trial` until it is clear that it's no better.
  bool trunkImproves(MatchedFigure& trial, const MatchedFigure& figure) const {
    double most = match_.trunk(trial.figure);
    trial.trunk = most;
    for (const double limb : figure.limbs) most += limb + kMaxGain;
    for (int limb = 0; limb < kFigureLimbs && most > figure.total; ++limb) {
      trial.limbs[limb] = match_.limb(trial.figure, limb);
      most += trial.limbs[limb] - figure.limbs[limb] - kMaxGain;
    }
    return most > figure.total && sumImproves(trial, figure);
  }

  // The overlap of limbs is measured only where it matters.
  static bool sumImproves(MatchedFigure& trial, const MatchedFigure& figure) {
    double most = trial.trunk;
    for (const double limb : trial.limbs) most += limb;
    if (most <= figure.total) return false;
    sumUp(trial);
    return better(trial, figure);
  }

  static void keepApart(std::vector<MatchedFigure>& figures, std::size_t most) {
    figures = bestApart(
        std::move(figures), most, [](const MatchedFigure& figure) { return figure.total; },
        [](const MatchedFigure& a, const MatchedFigure& b) {
          const double near = kAlike * b.figure.stature;
          bool every = true;
          for (int limb = 0; limb < kFigureLimbs; ++limb) {
            every = every && alike(a.figure.positions(limb), b.figure.positions(limb), near, near);
          }
          return every;
        });
  }

  const BodyVolume& body_;
  const FigureMatch& match_;
  const FigureSearch& options_;
  Progress& progress_;
  std::vector<MatchedFigure> figures_;
  std::vector<std::unique_ptr<const LimbFinder>> finders_;
};

}  // namespace

std::optional<MatchedFigure> findFigure(const BodyVolume& body, const FigureSearch& search, Progress& progress) {
  std::optional<FigureGround> ground;
  if (const std::optional<double> top = plinthTop(body, search.up)) ground = FigureGround{search.up, *top};
  const FigureMatch match(*body.distance, search.pins, ground);
  return Search(body, match, search, progress).run();
}

}  // namespace limber
