#include "limber/limbs/leg_bend.h"

#include <algorithm>
#include <cmath>

#include "limber/limbs/smooth.h"

namespace limber {

namespace {

constexpr double kLeastBend = 0.05, kMostBend = 1.4;  // radians
constexpr double kSoftFold = 0.1;                     // of the way from folded to straight

}  // namespace

LegBend::Chain::Chain(const Skeleton& skeleton, const NeutralPose& neutral, const LegJoints& leg)
    : upper(leg.upper), end(leg.end) {
  const std::vector<Vec3>& rest = neutral.restPositions;
  Index below = leg.end;
  double longest = 0;
  for (std::optional<Index> at = leg.carrier ? leg.carrier : skeleton.joints[leg.end].parent; at && below != leg.upper;
       at = skeleton.joints[*at].parent) {
    const double bone = (rest[below] - rest[*at]).norm();
    length += bone;
    longest = std::max(longest, bone);
    below = *at;
  }
  folded = std::max(2 * longest - length, 0.0);
  atRest = bend(neutral.positions);
}

double LegBend::Chain::bend(const std::vector<Vec3>& positions) const {
  return std::acos(std::min(1.0, (positions[end] - positions[upper]).norm() / length));
}

LegBend::LegBend(const RetargetSetup& setup, const AnimalLeg& leg)
    : source_(*setup.source, setup.sourceNeutral, leg.source),
      target_(*setup.target, setup.targetNeutral, leg.target) {}

double LegBend::reach(const BodyFrame& source) const {
  const double bend = source_.bend(source.positions) + target_.atRest - source_.atRest;
  const double reach = target_.length * std::cos(std::min(softPositive(bend, kLeastBend), kMostBend));
  const double room = target_.length - target_.folded, share = (reach - target_.folded) / room;
  return target_.folded + room * softPositive(share, kSoftFold) / softPositive(1, kSoftFold);
}

}  // namespace limber
