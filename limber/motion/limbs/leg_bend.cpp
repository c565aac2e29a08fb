#include "limber/motion/limbs/leg_bend.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/limbs/smooth.h"

namespace limber {

namespace {

// Set by hand, for a fox's clips on a cow and a wolf.
struct Bending {
  double straight = 0.5;       // radians; 0.3 to 0.8; added to bends, squared: else nearly straight knees snap
  double softStraight = 0.04;  // radians squared; 0.01 to 0.1; over which that ends without a kink
  double softFold = 0.1;       // radians; 0.05 to 0.3; over which the bend comes to its most
  double maxWithHock = 2.8;    // radians; 2.4 to pi; of knee and hock together, a right angle and a bit each
};
constexpr Bending kBending;

struct Bones {
  double all = 0, longest = 0;
};

Bones bonesOf(const Skeleton& skeleton, const std::vector<Vec3>& rest, const LegJoints& leg) {
  Bones bones;
  Index below = leg.end;
  for (std::optional<Index> at = leg.carrier ? leg.carrier : skeleton.joints[leg.end].parent; at && below != leg.upper;
       at = skeleton.joints[*at].parent) {
    const double bone = (rest[below] - rest[*at]).norm();
    bones.all += bone;
    bones.longest = std::max(bones.longest, bone);
    below = *at;
  }
  return bones;
}

}  // namespace

LegBend::Chain::Chain(const Skeleton& skeleton, const NeutralPose& neutral, const LegJoints& leg)
    : upper(leg.upper), end(leg.end) {
  const std::vector<Vec3>& rest = neutral.restPositions;
  first = (rest[leg.lower] - rest[leg.upper]).norm();
  second = (rest[leg.end] - rest[leg.lower]).norm();
  if (leg.hock) {
    const Bones bones = bonesOf(skeleton, rest, leg);
    first = second = 0.5 * bones.all;
    most = std::min(kBending.maxWithHock, bendAt(std::max(2 * bones.longest - bones.all, 0.0)));
  }
  atRest = bend(neutral.positions);
}

double LegBend::Chain::bendAt(double reach) const {
  const double cosine = (reach * reach - first * first - second * second) / (2 * first * second);
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double squared = cosine < 1 ? angle * angle : 2 * (1 - cosine);  // without a kink, also of overstretched legs
  return std::sqrt(softPositive(squared + kBending.straight * kBending.straight, kBending.softStraight));
}

double LegBend::Chain::reachAt(double bend) const {
  const double least = std::max(bend, 0.0);
  const double angle =
      std::sqrt(softPositive(least * least - kBending.straight * kBending.straight, kBending.softStraight));
  return std::sqrt(first * first + second * second + 2 * first * second * std::cos(angle));
}

double LegBend::Chain::bend(const std::vector<Vec3>& positions) const {
  return bendAt((positions[end] - positions[upper]).norm());
}

LegBend::LegBend(const RetargetSetup& setup, const LegJoints& source, const LegJoints& target)
    : source_(*setup.source, setup.sourceNeutral, source), target_(*setup.target, setup.targetNeutral, target) {}

double LegBend::reach(const BodyFrame& source) const {
  const double bend = source_.bend(source.positions) + target_.atRest - source_.atRest;
  return target_.reachAt(target_.most - softPositive(target_.most - bend, kBending.softFold));
}

}  // namespace limber
