#include "limber/retarget/least_changes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {

namespace {

constexpr std::size_t kJoinedFrames = 3;  // third differences reach no further
constexpr double kLoopWeight = 100;  // that a loop closes, against ChangeWeights::firm
constexpr double kTooFar = 1e-5;     // hip heights
constexpr std::array<double, 4> kThird = {-1, 3, -3, 1};

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

Vec3 wayAt(const Changes& changes, std::size_t first) {
  return {changes[first], changes[first + 1], changes[first + 2]};
}

LeastChanges::LeastChanges(const ChangeLayout& layout, std::vector<FootFrame> feet, std::vector<bool> cuts,
                           MotionEnds ends)
    : layout_(layout),
      feet_(std::move(feet)),
      cuts_(std::move(cuts)),
      ends_(ends),
      held_(feet_.size()),
      unbound_(layout_.frames() * layout_.perFrame(), 4 * layout_.perFrame() - 1, layout_.perFrame()),
      squares_(unbound_),
      values_(layout_.frames()),
      thirds_(layout_.frames() + 3, Vec3(Vec3::Zero())) {
  countThirds();
}

Changes LeastChanges::find(const ChangedMotion& now, const ChangeWeights& weights) {
  unbound_.clear();
  addChanges(weights);
  addPelvisJerk(now, weights.pelvisJerk);
  for (std::size_t leg = 0; leg < layout_.legs(); ++leg) addBones(leg, now, weights);
  std::fill(held_.begin(), held_.end(), Held{});
  Changes changes = now.changes;
  int round = 0;
  do {
    const Changes about = changes;
    squares_ = unbound_;
    holdBounds(weights.firm, about);
    changes = squares_.solve();
    if (!ends_.loops) continue;
    squares_ = unbound_;
    holdBounds(weights.firm, about);
    closeLoop(kLoopWeight * weights.firm, changes);
    changes = squares_.solve();
  } while (meetBounds(changes) && ++round < weights.rounds);
  return changes;
}

void LeastChanges::countThirds() {
  meets_.assign(layout_.frames(), {});
  for (std::size_t f = 3; f < layout_.frames(); ++f) {
    if (!isWhole(cuts_, f)) continue;
    for (std::size_t t = 0; t < 4; ++t) {
      for (std::size_t back = 0; back <= t; ++back) meets_[f - 3 + t][back] += kThird[t] * kThird[t - back];
    }
  }
}

bool LeastChanges::isPinned(std::size_t frame) const {
  return (ends_.startsJoined && frame < kJoinedFrames) ||
         (ends_.endsJoined && layout_.frames() - 1 - frame < kJoinedFrames);
}

void LeastChanges::addChanges(const ChangeWeights& weights) {
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    const std::size_t first = layout_.pelvis(f), feet = layout_.foot(f, 0), shoulders = layout_.shoulders(f);
    for (std::size_t i = first; i < layout_.pelvis(f + 1); ++i) {
      const bool isFoot = i >= feet && i < shoulders;
      const double own = isFoot ? weights.feet : i == first + 1 || i >= shoulders ? weights.pelvisUp : weights.pelvisLevel;
      const bool isKnown = f < kJoinedFrames && !ends_.start.empty();
      unbound_.add(std::array{Term{i, 1}}, isKnown ? ends_.start[i] : 0, isPinned(f) ? weights.firm : own);
    }
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) addFoot(f, leg, weights);
  }
}

void LeastChanges::addFoot(std::size_t frame, std::size_t leg, const ChangeWeights& weights) {
  const FootFrame& now = foot(frame, leg);
  const std::size_t at = layout_.foot(frame, leg);
  if (now.rest > 0) unbound_.add(std::array{Term{at + 1, 1}}, now.height, weights.rest * now.rest);
  if (frame == 0 || cuts_[frame]) return;
  const bool stands = now.stands || foot(frame - 1, leg).stands;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double weight = stands ? weights.firm : axis == 1 ? 0 : weights.hold * now.hold;
    if (weight == 0) continue;
    const std::array step = {Term{at + axis, 1}, Term{layout_.foot(frame - 1, leg) + axis, -1}};
    unbound_.add(step, axisOf(now.step, axis), weight);
  }
}

// Third differences of the paths as the changes would have them: frames meet in blocks.
void LeastChanges::addPelvisJerk(const ChangedMotion& now, double weight) {
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    const std::size_t at = layout_.pelvis(f);
    values_[f] = wayAt(now.changes, at) - now.paths[0][f];
    for (std::size_t back = 0; back <= std::min<std::size_t>(f, 3); ++back) {
      for (std::size_t a = 0; a < 3; ++a) {
        unbound_.matrix().at(at + a, layout_.pelvis(f - back) + a) += weight * meets_[f][back];
      }
    }
  }
  pullThirds();
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t a = 0; a < 3; ++a) unbound_.right()[layout_.pelvis(f) + a] += weight * axisOf(values_[f], a);
  }
}

// Bones follow the foot's way against the hip.
void LeastChanges::addBones(std::size_t leg, const ChangedMotion& now, const ChangeWeights& weights) {
  const BoneSlopes& slopes = now.slopes[leg];
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t back = 0; back <= std::min<std::size_t>(f, 3); ++back) {
      const double weight = weights.boneJerk * meets_[f][back] + (back == 0 ? weights.bones : 0);
      if (weight == 0) continue;
      Eigen::Matrix4d block = slopes[0][f].transpose() * slopes[0][f - back];
      block += slopes[1][f].transpose() * slopes[1][f - back];
      addBlock(leg, f, back, weight * block);
    }
  }
  std::vector<double>& right = unbound_.right();
  for (std::size_t bone = 0; bone < 2; ++bone) {
    for (std::size_t f = 0; f < layout_.frames(); ++f) {
      Eigen::Vector4d way;
      way << wayAt(now.changes, layout_.foot(f, leg)) - wayAt(now.changes, layout_.pelvis(f)),
          layout_.isTilted(leg) ? now.changes[layout_.shoulders(f)] : 0;
      values_[f] = slopes[bone][f] * way - now.bone(leg, bone)[f];
    }
    const Path own = values_;
    pullThirds();
    for (std::size_t f = 0; f < layout_.frames(); ++f) {
      const Vec3 value = weights.boneJerk * values_[f] + weights.bones * own[f];
      const Eigen::Vector4d pull = slopes[bone][f].transpose() * value;
      for (std::size_t a = 0; a < 3; ++a) {
        right[layout_.pelvis(f) + a] -= pull[static_cast<Eigen::Index>(a)];
        right[layout_.foot(f, leg) + a] += pull[static_cast<Eigen::Index>(a)];
      }
      if (layout_.isTilted(leg)) right[layout_.shoulders(f)] += pull[3];
    }
  }
}

// `block`: of the foot's way against the hip and of the shoulders' rise, in a frame and so many frames back.
void LeastChanges::addBlock(std::size_t leg, std::size_t frame, std::size_t back, const Eigen::Matrix4d& block) {
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
      unbound_.matrix().at(row + unknowns[i].at, column + unknowns[j].at) +=
          unknowns[i].sign * unknowns[j].sign * block(unknowns[i].of, unknowns[j].of);
    }
  }
}

// How the squared third differences of the values pull at each of them: in their place.
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
      Held& held = held_[f * layout_.legs() + leg];
      const bool under = changes[layout_.foot(f, leg) + 1] < bounds.lowest - kTooFar;
      const bool beyond = legAt(changes, f, leg).norm() > bounds.most + kTooFar;
      more = more || (under && !held.up) || (beyond && !held.near);
      held.up = held.up || under;
      held.near = held.near || beyond;
    }
  }
  return more;
}

void LeastChanges::holdBounds(double weight, const Changes& about) {
  std::vector<Term> along;
  for (std::size_t f = 0; f < layout_.frames(); ++f) {
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
      const FootFrame& bounds = foot(f, leg);
      const Held& held = held_[f * layout_.legs() + leg];
      const std::size_t hip = layout_.pelvis(f), end = layout_.foot(f, leg);
      if (held.up) squares_.add(std::array{Term{end + 1, 1}}, bounds.lowest, weight);
      if (!held.near) continue;
      const Vec3 line = legAt(about, f, leg).normalized();
      along.clear();
      for (std::size_t a = 0; a < 3; ++a) {
        along.push_back({hip + a, -axisOf(line, a)});
        along.push_back({end + a, axisOf(line, a)});
      }
      if (layout_.isTilted(leg)) along.push_back({layout_.shoulders(f), -line.dot(bounds.lift)});
      squares_.add(along, bounds.most - line.dot(bounds.way), weight);
    }
  }
}

// From the hip to the foot.
Vec3 LeastChanges::legAt(const Changes& changes, std::size_t frame, std::size_t leg) const {
  Vec3 way = foot(frame, leg).way + wayAt(changes, layout_.foot(frame, leg)) - wayAt(changes, layout_.pelvis(frame));
  if (layout_.isTilted(leg)) way -= changes[layout_.shoulders(frame)] * foot(frame, leg).lift;
  return way;
}

}  // namespace limber
