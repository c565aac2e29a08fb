#include "limber/retarget/even_changes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {

namespace {

constexpr std::size_t kJoinedFrames = 3;  // third differences reach no further
// Of what has to hold, against changes in hip heights: feet that stand, bounds, and frames that do not change.
constexpr double kFirmWeight = 1e8;
constexpr double kFirmUpTo = 1e6;    // the weight of jerk; it is more for more
constexpr double kLoopWeight = 100;  // that a loop closes, against the rest of it
constexpr double kTooFar = 1e-5;     // hip heights
constexpr int kRounds = 6;
constexpr std::array<double, 4> kThird = {-1, 3, -3, 1};

double axisOf(const Vec3& v, std::size_t axis) {
  return v[static_cast<Eigen::Index>(axis)];
}

}  // namespace

bool ChangeLayout::tilts() const {
  return std::find(tilted.begin(), tilted.end(), true) != tilted.end();
}

Vec3 wayAt(const Changes& changes, std::size_t first) {
  return {changes[first], changes[first + 1], changes[first + 2]};
}

LeastChanges::LeastChanges(const ChangeLayout& layout, std::vector<FootFrame> feet, std::vector<bool> cuts,
                           MotionEnds ends)
    : layout_(layout), feet_(std::move(feet)), cuts_(std::move(cuts)), ends_(ends), held_(feet_.size()) {}

Changes LeastChanges::find(const ChangedMotion& now, double jerkWeight) {
  const double firm = kFirmWeight * std::max(1.0, jerkWeight / kFirmUpTo);
  BandLeastSquares unbound(layout_.frames * layout_.perFrame(), 4 * layout_.perFrame() - 1);
  holdFeet(firm, unbound);
  addJerk(now, jerkWeight, unbound);
  Changes changes = now.changes;
  int round = 0;
  do {
    BandLeastSquares squares = unbound;
    holdBounds(firm, changes, squares);
    changes = squares.solve();
    if (ends_.loops) closeLoop(kLoopWeight * firm, changes, squares);
  } while (meetBounds(changes) && ++round < kRounds);
  return changes;
}

bool LeastChanges::isPinned(std::size_t frame) const {
  return (ends_.startsJoined && frame < kJoinedFrames) ||
         (ends_.endsJoined && layout_.frames - 1 - frame < kJoinedFrames);
}

void LeastChanges::holdFeet(double weight, BandLeastSquares& squares) const {
  for (std::size_t f = 0; f < layout_.frames; ++f) {
    for (std::size_t i = layout_.pelvis(f); i < layout_.pelvis(f + 1); ++i) {
      squares.add(std::array{Term{i, 1}}, 0, isPinned(f) ? weight : 1);
    }
    if (f == 0 || cuts_[f]) continue;
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
      if (!foot(f, leg).stands && !foot(f - 1, leg).stands) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        squares.add(std::array{Term{layout_.foot(f, leg) + axis, 1}, Term{layout_.foot(f - 1, leg) + axis, -1}}, 0,
                    weight);
      }
    }
  }
}

// Third differences as the changes would have them.
void LeastChanges::addJerk(const ChangedMotion& now, double weight, BandLeastSquares& squares) const {
  std::vector<Term> terms;
  const auto add = [&](const Vec3& is, std::size_t axis) {
    double aim = -axisOf(is, axis);
    for (const Term& term : terms) aim += term.factor * now.changes[term.unknown];
    squares.add(terms, aim, weight);
    terms.clear();
  };
  for (std::size_t f = 3; f < layout_.frames; ++f) {
    if (!isWhole(cuts_, f)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t t = 0; t < 4; ++t) terms.push_back({layout_.pelvis(f - 3 + t) + axis, kThird[t]});
      add(thirdDifference(now.paths[0], f), axis);
    }
    for (const BonePair& pair : now.bones) {
      for (std::size_t bone = 0; bone < 2; ++bone) {
        const Vec3 third = thirdDifference(now.paths[pair.firstPath + bone], f);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (std::size_t t = 0; t < 4; ++t) {
            const std::size_t at = f - 3 + t;
            const Eigen::RowVector4d slope = kThird[t] * pair.slopes[bone][at].row(static_cast<Eigen::Index>(axis));
            // By the foot's way against the hip.
            for (std::size_t a = 0; a < 3; ++a) {
              terms.push_back({layout_.pelvis(at) + a, -slope[static_cast<Eigen::Index>(a)]});
              terms.push_back({layout_.foot(at, pair.leg) + a, slope[static_cast<Eigen::Index>(a)]});
            }
            if (layout_.tilted[pair.leg]) terms.push_back({layout_.shoulders(at), slope[3]});
          }
          add(third, axis);
        }
      }
    }
  }
}

// Both ends halfway between what they would change.
void LeastChanges::closeLoop(double weight, Changes& changes, BandLeastSquares& squares) const {
  const std::size_t last = layout_.pelvis(layout_.frames - 1);
  for (std::size_t i = 0; i < layout_.perFrame(); ++i) {
    const double middle = (changes[i] + changes[last + i]) / 2;
    squares.add(std::array{Term{i, 1}}, middle, weight);
    squares.add(std::array{Term{last + i, 1}}, middle, weight);
  }
  changes = squares.solve();
}

bool LeastChanges::meetBounds(const Changes& changes) {
  bool more = false;
  for (std::size_t f = 0; f < layout_.frames; ++f) {
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

void LeastChanges::holdBounds(double weight, const Changes& about, BandLeastSquares& squares) const {
  std::vector<Term> along;
  for (std::size_t f = 0; f < layout_.frames; ++f) {
    for (std::size_t leg = 0; leg < layout_.legs(); ++leg) {
      const FootFrame& bounds = foot(f, leg);
      const Held& held = held_[f * layout_.legs() + leg];
      const std::size_t hip = layout_.pelvis(f), end = layout_.foot(f, leg);
      if (held.up) squares.add(std::array{Term{end + 1, 1}}, bounds.lowest, weight);
      if (!held.near) continue;
      const Vec3 line = legAt(about, f, leg).normalized();
      along.clear();
      for (std::size_t a = 0; a < 3; ++a) {
        along.push_back({hip + a, -axisOf(line, a)});
        along.push_back({end + a, axisOf(line, a)});
      }
      if (layout_.tilted[leg]) along.push_back({layout_.shoulders(f), -line.y()});
      squares.add(along, bounds.most - line.dot(bounds.way), weight);
    }
  }
}

// From the hip to the foot.
Vec3 LeastChanges::legAt(const Changes& changes, std::size_t frame, std::size_t leg) const {
  Vec3 way = foot(frame, leg).way + wayAt(changes, layout_.foot(frame, leg)) - wayAt(changes, layout_.pelvis(frame));
  if (layout_.tilted[leg]) way.y() -= changes[layout_.shoulders(frame)];
  return way;
}

}  // namespace limber
