#include "limber/figure/figure_search.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "limber/core/parallel.h"
#include "limber/core/random.h"
#include "limber/figure/limb_finder.h"
#include "limber/figure/trunk_search.h"

namespace limber {

namespace {

constexpr double kLeastHead = 0.45;  // match of a head below which there is none
constexpr std::size_t kChests = 80;  // that hang from a head of one stature
constexpr std::size_t kTrunks = 800, kKept = 24, kImproved = 12;
constexpr int kRounds = 3;  // of limbs found anew and improved
constexpr int kFirstSteps = 1200, kSteps = 1500, kLimbSteps = 200;
constexpr std::size_t kReconsidered = 6;
constexpr std::size_t kPolished = 4;
constexpr int kPolishSteps = 3000;
constexpr int kReconsiderRounds = 2, kReconsiderSteps = 400;
constexpr std::size_t kFewMiddles = 24, kManyMiddles = 80;
constexpr std::size_t kFewLimbs = 6, kManyLimbs = 24, kTriedLimbs = 10;
constexpr double kAlike = 0.08;  // statures between elbows, knees, wrists and ankles
constexpr double kAlikeMiddle = 0.04, kAlikeAnkle = 0.05;
constexpr double kMostScale = 1.4, kLeastScale = 0.7, kMostShift = 0.05;
constexpr double kMostNeck = 0.09, kLeastNeck = 0.01;

using Candidates = std::vector<LimbFinder::Candidate>;

bool better(const MatchedFigure& a, const MatchedFigure& b) {
  return a.total > b.total;
}

Mat3 randomTurn(Random& random, double angle) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  const Vec3 turn = angle * Vec3(x, y, z);
  const double size = turn.norm();
  return size > 0 ? Eigen::AngleAxisd(size, turn / size).toRotationMatrix() : Mat3(Mat3::Identity());
}

Vec3 randomStep(Random& random, double size) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return size * Vec3(x, y, z);
}

// Steps get smaller where none has been for the better for a while.
class StepSize {
 public:
  explicit StepSize(int patience, double factor) : patience_(patience), factor_(factor) {}
  double value() const { return value_; }
  void succeeded() { failures_ = 0; }
  // Whether it is worth to go on.
  bool failed() {
    if (++failures_ <= patience_) return true;
    failures_ = 0;
    value_ *= factor_;
    return value_ >= 0.15;
  }

 private:
  int patience_, failures_ = 0;
  double factor_, value_ = 1;
};

void turnLimb(FigureLimb& bones, const Mat3& turn) {
  bones.upper = turn * bones.upper;
  bones.lower = turn * bones.lower;
  bones.end = turn * bones.end;
}

// One small change of one limb.
void stepLimb(Figure& figure, int limb, double size, Random& random) {
  FigureLimb& bones = figure.limbs[limb];
  const double angle = 0.25 * size;
  switch (random.below(6)) {
    case 0:
      bones.upper = randomTurn(random, angle) * bones.upper;
      break;
    case 1: {
      const Mat3 turn = randomTurn(random, angle);
      bones.lower = turn * bones.lower;
      bones.end = turn * bones.end;
      break;
    }
    case 2:
      turnLimb(bones, randomTurn(random, angle));
      break;
    case 3: {  // elbow or knee moves, wrist or ankle stays about where it is
      const FigureLimbPlaces places = figure.places(limb);
      const Vec3 middle = places.middle + randomStep(random, 0.03 * size * figure.stature);
      bones.upper = (middle - places.root).normalized();
      bones.lower = (places.ankle - middle).normalized();
      break;
    }
    case 4: {
      double& scale = random.below(2) == 0 ? bones.upperScale : bones.lowerScale;
      scale = std::clamp(scale * std::exp(0.06 * size * random.normal()), kLeastScale, kMostScale);
      break;
    }
    default:
      if (isLeg(limb)) {
        bones.end = randomTurn(random, 1.5 * angle) * bones.end;
      } else {
        const Vec3 shift = bones.shift + randomStep(random, 0.012 * size);
        if (shift.norm() < kMostShift) bones.shift = shift;
      }
  }
  if (!isLeg(limb)) bones.end = bones.lower;
}

// One small change of the head or the trunk.
void stepTrunk(Figure& figure, double size, Random& random) {
  const double angle = 0.22 * size;
  switch (random.below(7)) {
    case 0:
      figure.head += randomStep(random, 0.02 * size * figure.stature);
      break;
    case 1:
      figure.headRadius *= std::exp(0.05 * size * random.normal());
      break;
    case 2:
      figure.stature *= std::exp(0.05 * size * random.normal());
      break;
    case 3:
      figure.neckLength = std::clamp(figure.neckLength + 0.01 * size * random.normal(), kLeastNeck, kMostNeck);
      break;
    case 4:
      figure.neck = randomTurn(random, angle) * figure.neck;
      break;
    case 5: {
      const Mat3 turn = randomTurn(random, angle);
      figure.chest = turn * figure.chest;
      if (random.below(2) == 0) break;
      for (const int arm : {0, 1}) turnLimb(figure.limbs[arm], turn);
      break;
    }
    default:
      figure.pelvis = randomTurn(random, angle) * figure.pelvis;
  }
}

// Left for right and front for back, the limbs where they are; straight where they would bend the wrong way.
Figure turnedAround(Figure figure) {
  for (Mat3* axes : {&figure.chest, &figure.pelvis}) {
    axes->col(0) *= -1;
    axes->col(2) *= -1;
  }
  std::swap(figure.limbs[0], figure.limbs[1]);
  std::swap(figure.limbs[2], figure.limbs[3]);
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    FigureLimb& bones = figure.limbs[limb];
    bones.shift = Vec3(-bones.shift.x(), bones.shift.y(), -bones.shift.z());
    if (isLeg(limb)) bones.end = toesForward(figure, limb).normalized();
    if (limbAllowed(figure, limb)) continue;
    const FigureLimbPlaces places = figure.places(limb);
    bones.upper = bones.lower = (places.ankle - places.root).normalized();
    bones.end = isLeg(limb) ? toesForward(figure, limb).normalized() : bones.lower;
  }
  return figure;
}

class Search {
 public:
  Search(const BodyVolume& body, const FigureMatch& match, const FigureSearch& options)
      : body_(body), match_(match), options_(options) {}

  std::optional<MatchedFigure> run() {
    std::vector<HeadBall> heads = findHeads(body_, match_, options_.up);
    std::erase_if(heads, [](const HeadBall& head) { return head.match < kLeastHead; });
    std::vector<MatchedFigure> figures = trunks(heads);
    if (figures.empty()) return {};
    parallelFor(figures.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) holdLimbs(figures[i], kFewMiddles, kFewLimbs, nullptr);
    });
    keepApart(figures, kKept);
    const auto improveAll = [&](auto&& improveOne) {
      parallelFor(figures.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          Random random(i);
          improveOne(figures[i], random);
        }
      });
      std::stable_sort(figures.begin(), figures.end(), better);
    };
    improveAll([&](MatchedFigure& figure, Random& random) { improve(figure, kFirstSteps, random); });
    keepApart(figures, kImproved);
    improveAll([&](MatchedFigure& figure, Random& random) {
      for (int round = 0; round < kRounds; ++round) {
        MatchedFigure other = figure;
        holdLimbs(other, kManyMiddles, kManyLimbs, &random);
        improve(other, kSteps, random);
        if (better(other, figure)) figure = other;
      }
    });
    keepApart(figures, kReconsidered);
    improveAll([&](MatchedFigure& figure, Random& random) { reconsider(figure, random); });
    // The best once more, each time by other steps; and as it would face the other way, which feet alone may tell.
    figures.assign(kPolished, figures.front());
    const Figure around = turnedAround(figures.front().figure);
    if (allowed(around)) std::fill_n(figures.begin(), kPolished / 2, matched(match_, around));
    improveAll([&](MatchedFigure& figure, Random& random) {
      improve(figure, kPolishSteps, random);
      reconsider(figure, random);
    });
    if (figures.front().total < -1e8) return {};
    return figures.front();
  }

 private:
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
      const auto has = [&, size = stature](const MatchedFigure& trunk) { return trunk.figure.stature == size; };
      if (std::any_of(trunks.begin(), trunks.end(), has)) {
        finders_.push_back(std::make_unique<LimbFinder>(body_, match_, stature));
      }
    }
    return trunks;
  }

  const LimbFinder& finderFor(double stature) const {
    const auto off = [&](const auto& finder) { return std::abs(std::log(finder->stature() / stature)); };
    return **std::min_element(finders_.begin(), finders_.end(),
                              [&](const auto& a, const auto& b) { return off(a) < off(b); });
  }

  // Finds limbs for a trunk: the best for each, then others where limbs share a place. With `random`, each is improved
  // for itself first.
  void holdLimbs(MatchedFigure& figure, std::size_t widely, std::size_t most, Random* random) const {
    std::array<Candidates, kFigureLimbs> candidates;
    const LimbFinder& finder = finderFor(figure.figure.stature);
    for (int limb = 0; limb < kFigureLimbs; ++limb) {
      candidates[limb] = finder.find(figure.figure, limb, widely, most);
      if (candidates[limb].empty()) {
        figure.total = -1e9;
        return;
      }
      if (random) improveEach(figure.figure, limb, candidates[limb], *random);
      figure.figure.limbs[limb] = candidates[limb].front().bones;
      figure.limbs[limb] = candidates[limb].front().match;
    }
    figure.trunk = match_.trunk(figure.figure);
    sumUp(figure);
    exchange(figure, candidates);
  }

  // Pairs of limbs are exchanged together, as long as that is for the better.
  static void exchange(MatchedFigure& figure, const std::array<Candidates, kFigureLimbs>& candidates) {
    constexpr int kPairs[][2] = {{0, 1}, {2, 3}, {0, 2}, {0, 3}, {1, 2}, {1, 3}};
    for (int round = 0; round < 3; ++round) {
      const double before = figure.total;
      for (const auto& [a, b] : kPairs) {
        MatchedFigure trial = figure;
        for (const LimbFinder::Candidate& first : candidates[a]) {
          trial.figure.limbs[a] = first.bones;
          trial.limbs[a] = first.match;
          for (const LimbFinder::Candidate& second : candidates[b]) {
            trial.figure.limbs[b] = second.bones;
            trial.limbs[b] = second.match;
            sumUp(trial);
            if (better(trial, figure)) figure = trial;
          }
        }
      }
      if (figure.total <= before) return;
    }
  }

  void improveEach(const Figure& figure, int limb, Candidates& candidates, Random& random) const {
    Figure trial = figure;
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
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.match > b.match; });
    Candidates apart;
    std::vector<FigureLimbPlaces> taken;
    for (const LimbFinder::Candidate& candidate : candidates) {
      trial.limbs[limb] = candidate.bones;
      const FigureLimbPlaces places = trial.places(limb);
      const auto isAlike = [&](const FigureLimbPlaces& other) {
        return (other.middle - places.middle).norm() < kAlikeMiddle * figure.stature &&
               (other.ankle - places.ankle).norm() < kAlikeAnkle * figure.stature;
      };
      if (apart.size() >= kTriedLimbs || std::any_of(taken.begin(), taken.end(), isAlike)) continue;
      taken.push_back(places);
      apart.push_back(candidate);
    }
    candidates = std::move(apart);
  }

  // Tries other ways to hold each limb, with the whole figure improved for each: a trunk fits the limbs it was found
  // with better than any others.
  void reconsider(MatchedFigure& figure, Random& random) const {
    for (int round = 0; round < kReconsiderRounds; ++round) {
      const double before = figure.total;
      for (int limb = 0; limb < kFigureLimbs; ++limb) {
        Candidates candidates = finderFor(figure.figure.stature).find(figure.figure, limb, kManyMiddles, kManyLimbs);
        improveEach(figure.figure, limb, candidates, random);
        MatchedFigure best = figure;
        for (const LimbFinder::Candidate& candidate : candidates) {
          MatchedFigure trial = figure;
          trial.figure.limbs[limb] = candidate.bones;
          trial.limbs[limb] = candidate.match;
          sumUp(trial);
          improve(trial, kReconsiderSteps, random);
          if (better(trial, best)) best = trial;
        }
        figure = best;
      }
      if (figure.total <= before) return;
    }
  }

  // Small random steps of the whole figure, as long as they are for the better.
  void improve(MatchedFigure& figure, int steps, Random& random) const {
    if (figure.total < -1e8) return;
    StepSize size(120, 0.7);
    for (int step = 0; step < steps; ++step) {
      MatchedFigure trial = figure;
      const int part = static_cast<int>(random.below(9)) - 5;
      if (part < 0) {
        stepTrunk(trial.figure, size.value(), random);
        if (!allowed(trial.figure)) continue;
        trial = matched(match_, trial.figure);
      } else {
        stepLimb(trial.figure, part, size.value(), random);
        if (!limbAllowed(trial.figure, part)) continue;
        trial.limbs[part] = match_.limb(trial.figure, part);
        sumUp(trial);
      }
      if (better(trial, figure)) {
        figure = trial;
        size.succeeded();
      } else if (!size.failed()) {
        return;
      }
    }
  }

  static void keepApart(std::vector<MatchedFigure>& figures, std::size_t most) {
    std::stable_sort(figures.begin(), figures.end(), better);
    std::vector<MatchedFigure> apart;
    for (const MatchedFigure& figure : figures) {
      if (apart.size() >= most) break;
      const auto isAlike = [&](const MatchedFigure& other) {
        double farthest = 0;
        for (int limb = 0; limb < kFigureLimbs; ++limb) {
          const FigureLimbPlaces a = figure.figure.places(limb), b = other.figure.places(limb);
          farthest = std::max({farthest, (a.middle - b.middle).norm(), (a.ankle - b.ankle).norm()});
        }
        return farthest < kAlike * figure.figure.stature;
      };
      if (std::none_of(apart.begin(), apart.end(), isAlike)) apart.push_back(figure);
    }
    figures = std::move(apart);
  }

  const BodyVolume& body_;
  const FigureMatch& match_;
  const FigureSearch& options_;
  std::vector<std::unique_ptr<const LimbFinder>> finders_;
};

}  // namespace

std::optional<MatchedFigure> findFigure(const BodyVolume& body, const FigureSearch& search) {
  const FigureMatch match(*body.distance, search.pins);
  return Search(body, match, search).run();
}

}  // namespace limber
