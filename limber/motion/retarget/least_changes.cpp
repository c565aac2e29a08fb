#include "limber/motion/retarget/least_changes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {

namespace {

struct Weighting {
  // Weight of what has to hold (planted feet, bounds, frames that do not change) against squared changes in hip
  // heights; 1e6 to 1e10, between what is seen and what is lost in rounding; set by hand.
  double firmWeight = 1e8;
  double firmUpTo = 1e6;    // weight of jerk; 1e4 to firmWeight; above it that weight grows; set by hand
  double loopWeight = 100;  // times that weight; 10 to 1000; that a loop closes; set by hand
  double tooFar = 1e-5;     // hip heights; 1e-6 to 1e-4; by which bounds may be missed, below what is seen
};
constexpr Weighting kWeighting;

double axisOf(const Vec3& v, std::size_t axis) {
  return v[static_cast<Eigen::Index>(axis)];
}

}  // namespace

ChangeLayout::ChangeLayout(std::size_t frames, std::vector<bool> tilted)
    : frames_(frames),
      tilted_(std::move(tilted)),
      tilts_(std::find(tilted_.begin(), tilted_.end(), true) != tilted_.end()) {
  perFrame_ = 3 * (1 + tilted_.size()) + (tilts_ ? 1 : 0);
}

Vec3 displacementAt(const Changes& changes, std::size_t first) {
  return {changes[first], changes[first + 1], changes[first + 2]};
}

LeastChanges::LeastChanges(const ChangeLayout& layout, std::vector<FootFrame> feet, std::vector<bool> cuts,
                           MotionEnds ends, const ChangeWeights& weights)
    : layout_(layout),
      feet_(std::move(feet)),
      cuts_(std::move(cuts)),
      ends_(std::move(ends)),
      weights_(weights),
      pinned_(feet_.size()),
      jerk_(layout_.frames() * layout_.perFrame(), 4 * layout_.perFrame() - 1, layout_.perFrame()),
      closeness_(jerk_),
      unbound_(jerk_),
      squares_(jerk_),
      values_(layout_.frames()),
      thirds_(layout_.frames() + 3, Vec3(Vec3::Zero())) {
  countThirds();
}

void LeastChanges::start(const ChangedMotion& now) {
  start_ = now.changes;
  jerk_.clear();
  closeness_.clear();
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    addOwnChanges(f);
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) addFoot(f, leg);
  }
  addPelvisJerk(now);
  for (std::size_t leg = 0; leg < layout_.legs(); ++leg) addBones(leg, now);
}

Changes LeastChanges::find(double jerkWeight) {
  const double firm = kWeighting.firmWeight * std::max(1.0, jerkWeight / kWeighting.firmUpTo);
  unbound_ = closeness_;
  unbound_.addScaled(jerk_, jerkWeight);
  holdPlanted(firm);
  std::fill(pinned_.begin(), pinned_.end(), Pinned{});
  Changes changes = start_;
  int round = 0;
  do {
    const Changes about = changes;
    squares_ = unbound_;
    holdBounds(firm, about);
    changes = squares_.solve();
    if (!ends_.loops) continue;
    squares_ = unbound_;
    holdBounds(firm, about);
    closeLoop(kWeighting.loopWeight * firm, changes);
    changes = squares_.solve();
  } while (meetBounds(changes) && ++round < weights_.rounds);
  return changes;
}

void LeastChanges::countThirds() {
  meets_.assign(layout_.frames(), {});
  for (std::size_t f = 3; f < layout_.frames(); ++f) {
    if (!isWhole(cuts_, f)) continue;
    for (std::size_t t = 0; t < 4; ++t) {
      for (std::size_t back = 0; back <= t; ++back)
        meets_[f - 3 + t][back] += kThirdDifference[t] * kThirdDifference[t - back];
    }
  }
}

bool LeastChanges::isPinned(std::size_t frame) const {
  return (ends_.startsJoined && frame < kJoinedFrames) ||
         (ends_.endsJoined && layout_.frames() - 1 - frame < kJoinedFrames);
}

void LeastChanges::addOwnChanges(std::size_t frame) {
  if (isPinned(frame)) return;
  const std::size_t first = layout_.pelvis(frame), feet = layout_.foot(frame, 0), shoulders = layout_.shoulders(frame);
  for (std::size_t i = first; i < layout_.pelvis(frame + 1); ++i) {
    const bool isFoot = i >= feet && i < shoulders, isUp = i == first + 1 || i >= shoulders;
    const double support = supportOf(frame, i >= shoulders);
    const double up = weights_.pelvisLevel + support * (weights_.pelvisUp - weights_.pelvisLevel);
    closeness_.add(std::array{Term{i, 1}}, 0, isFoot ? weights_.feet : isUp ? up : weights_.pelvisLevel);
  }
}

// How firmly feet carry the hips or the shoulders, 0 to 1: those that are held, or whose height counts for more.
double LeastChanges::supportOf(std::size_t frame, bool shoulders) const {
  double support = 0;
  for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
    const FootFrame& now = foot(frame, leg);
    if (layout_.isTilted(leg) != shoulders) continue;
    const double rest = weights_.rest * now.rest;
    support = std::max({support, now.hold, rest / (rest + weights_.pelvisLevel)});
  }
  return support;
}

void LeastChanges::addFoot(std::size_t frame, std::size_t leg) {
  const FootFrame& now = foot(frame, leg);
  const std::size_t at = layout_.foot(frame, leg);
  if (now.rest > 0) closeness_.add(std::array{Term{at + 1, 1}}, now.height, weights_.rest * now.rest);
  if (!(now.hold > 0) || frame == 0 || cuts_[frame]) return;
  for (const std::size_t axis : {0, 2}) {
    closeness_.add(std::array{Term{at + axis, 1}, Term{layout_.foot(frame - 1, leg) + axis, -1}},
                   axisOf(now.step, axis), weights_.hold * now.hold);
  }
}

// What has to hold whatever jerk counts.
void LeastChanges::holdPlanted(double weight) {
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t i = layout_.pelvis(f); isPinned(f) && i < layout_.pelvis(f + 1); ++i) {
      const bool isKnown = f < kJoinedFrames && !ends_.start.empty();
      unbound_.add(std::array{Term{i, 1}}, isKnown ? ends_.start[i] : 0, weight);
    }
    if (f == 0 || cuts_[f]) continue;
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
      if (!foot(f, leg).planted && !foot(f - 1, leg).planted) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        unbound_.add(std::array{Term{layout_.foot(f, leg) + axis, 1}, Term{layout_.foot(f - 1, leg) + axis, -1}}, 0,
                     weight);
      }
    }
  }
}

// Third differences of the paths as the changes would have them: frames meet in blocks.
void LeastChanges::addPelvisJerk(const ChangedMotion& now) {
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    const std::size_t at = layout_.pelvis(f);
    values_[f] = displacementAt(now.changes, at) - now.paths[0][f];
    for (std::size_t back = 0; back <= std::min<std::size_t>(f, 3); ++back) {
      for (std::size_t a = 0; a < 3; ++a) jerk_.matrix().at(at + a, layout_.pelvis(f - back) + a) += meets_[f][back];
    }
  }
  pullThirds();
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t a = 0; a < 3; ++a) jerk_.right()[layout_.pelvis(f) + a] += axisOf(values_[f], a);
  }
}

// Bones follow the foot's displacement against the hip.
void LeastChanges::addBones(std::size_t leg, const ChangedMotion& now) {
  const BoneSlopes& slopes = now.slopes[leg];
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t back = 0; back <= std::min<std::size_t>(f, 3); ++back) {
      if (meets_[f][back] == 0 && (back > 0 || weights_.bones == 0)) continue;
      Eigen::Matrix4d block = slopes[0][f].transpose() * slopes[0][f - back];
      block += slopes[1][f].transpose() * slopes[1][f - back];
      addBlock(leg, f, back, meets_[f][back] * block, jerk_);
      if (back == 0 && weights_.bones > 0) addBlock(leg, f, back, weights_.bones * block, closeness_);
    }
  }
  std::vector<double>& right = jerk_.right();
  for (std::size_t bone = 0; bone < 2; ++bone) {
    for (std::size_t f = 0; f < layout_.frames(); ++f) {
      Eigen::Vector4d displacement;
      displacement << displacementAt(now.changes, layout_.foot(f, leg)) -
                          displacementAt(now.changes, layout_.pelvis(f)),
          layout_.isTilted(leg) ? now.changes[layout_.shoulders(f)] : 0;
      values_[f] = slopes[bone][f] * displacement - now.bone(leg, bone)[f];
    }
    pullThirds();
    for (std::size_t f = 0; f < layout_.frames(); ++f) {
      const Eigen::Vector4d pull = slopes[bone][f].transpose() * values_[f];
      for (std::size_t a = 0; a < 3; ++a) {
        right[layout_.pelvis(f) + a] -= pull[static_cast<Eigen::Index>(a)];
        right[layout_.foot(f, leg) + a] += pull[static_cast<Eigen::Index>(a)];
      }
      if (layout_.isTilted(leg)) right[layout_.shoulders(f)] += pull[3];
    }
  }
}

// `block`: of the foot's displacement against the hip and of the shoulders' rise, in a frame and so many frames back.
void LeastChanges::addBlock(std::size_t leg, std::size_t frame, std::size_t back, const Eigen::Matrix4d& block,
                            BandLeastSquares& squares) {
  struct Unknown {
    std::size_t at;
    Eigen::Index of;
    double sign;
  };
  std::array<Unknown, 7> unknowns;
  const std::size_t count = layout_.isTilted(leg) ? 7 : 6;
  for (std::size_t a = 0; a < 3; ++a) {
    unknowns[a] = {a, static_cast<Eigen::Index>(a), -1};
    unknowns[3 + a] = {layout_.foot(0, leg) + a, static_cast<Eigen::Index>(a), 1};
  }
  unknowns[6] = {layout_.shoulders(0), 3, 1};
  const std::size_t row = layout_.pelvis(frame), column = layout_.pelvis(frame - back);
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = back == 0 ? j : 0; i < count; ++i) {
      squares.matrix().at(row + unknowns[i].at, column + unknowns[j].at) +=
          unknowns[i].sign * unknowns[j].sign * block(unknowns[i].of, unknowns[j].of);
    }
  }
}

// Replaces the values by half the gradient of the sum of their squared third differences.
void LeastChanges::pullThirds() {
  for (std::size_t f = 3; f < layout_.frames(); ++f) {
    if (isWhole(cuts_, f)) thirds_[f] = thirdDifference(values_, f);
  }
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    values_[f] = (thirds_[f] - thirds_[f + 3]) + 3 * (thirds_[f + 2] - thirds_[f + 1]);
  }
}

// Both ends halfway between what they would change.
void LeastChanges::closeLoop(double weight, const Changes& changes) {
  const std::size_t last = layout_.pelvis(layout_.frames() - 1);
  for (std::size_t i = 0; i < layout_.perFrame(); ++i) {
    const double middle = (changes[i] + changes[last + i]) / 2;
    squares_.add(std::array{Term{i, 1}}, middle, weight);
    squares_.add(std::array{Term{last + i, 1}}, middle, weight);
  }
}

bool LeastChanges::meetBounds(const Changes& changes) {
  bool more = false;
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
      const FootFrame& bounds = foot(f, leg);
      Pinned& pinned = pinned_[f * layout_.legs() + leg];
      const bool under = changes[layout_.foot(f, leg) + 1] < bounds.lowest - kWeighting.tooFar;
      const bool beyond = legAt(changes, f, leg).norm() > bounds.most + kWeighting.tooFar;
      more = more || (under && !pinned.up) || (beyond && !pinned.near);
      pinned.up = pinned.up || under;
      pinned.near = pinned.near || beyond;
    }
  }
  return more;
}

void LeastChanges::holdBounds(double weight, const Changes& about) {
  std::vector<Term> along;
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
      const FootFrame& bounds = foot(f, leg);
      const Pinned& pinned = pinned_[f * layout_.legs() + leg];
      const std::size_t hip = layout_.pelvis(f), end = layout_.foot(f, leg);
      if (pinned.up) squares_.add(std::array{Term{end + 1, 1}}, bounds.lowest, weight);
      if (!pinned.near) continue;
      const Vec3 line = legAt(about, f, leg).normalized();
      along.clear();
      for (std::size_t a = 0; a < 3; ++a) {
        along.push_back({hip + a, -axisOf(line, a)});
        along.push_back({end + a, axisOf(line, a)});
      }
      if (layout_.isTilted(leg)) along.push_back({layout_.shoulders(f), -line.dot(bounds.lift)});
      squares_.add(along, bounds.most - line.dot(bounds.displacement), weight);
    }
  }
}

// From the hip to the foot.
Vec3 LeastChanges::legAt(const Changes& changes, std::size_t frame, std::size_t leg) const {
  Vec3 displacement = foot(frame, leg).displacement + displacementAt(changes, layout_.foot(frame, leg)) -
                      displacementAt(changes, layout_.pelvis(frame));
  if (layout_.isTilted(leg)) displacement -= changes[layout_.shoulders(frame)] * foot(frame, leg).lift;
  return displacement;
}

}  // namespace limber
