#include "limber/motion/limbs/limb.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/limbs/leg_bend.h"
#include "limber/skeleton/chain.h"

namespace limber {

bool anyFootDriven(std::span<const Leg> legs) {
  return std::any_of(legs.begin(), legs.end(), [](const Leg& leg) { return leg.footDriven; });
}

std::optional<Limb> makeLimb(const RetargetSetup& setup, const RootPositioner& root, const LegJoints& source,
                             const LegJoints& target) {
  Limb limb;
  limb.upper = target.upper;
  limb.lower = target.lower;
  limb.end = target.end;
  limb.sourceUpper = source.upper;
  limb.sourceEnd = source.end;
  if (!isAncestorOrSelf(*setup.target, limb.upper, limb.lower)) return std::nullopt;
  if (!isAncestorOrSelf(*setup.target, limb.lower, root.carrierOf(limb.end))) return std::nullopt;
  const std::vector<Vec3>& rest = setup.targetNeutral.restPositions;
  const double upperLength = (rest[limb.lower] - rest[limb.upper]).norm();
  const double lowerLength = (rest[limb.end] - rest[limb.lower]).norm();
  if (!(upperLength > 0) || !(lowerLength > 0)) return std::nullopt;
  limb.length = upperLength + lowerLength;
  limb.folded = std::sqrt(upperLength * upperLength + lowerLength * lowerLength +
                          2 * upperLength * lowerLength * std::cos(kMaxBend));
  return limb;
}

std::optional<Limb> findLimb(const RetargetSetup& setup, const RootPositioner& root, PartKind kind, Side side) {
  const auto find = [&](Segment segment) { return setup.map.find({kind, side, 0, segment, 0}); };
  const JointMatch *u = find(Segment::kUpper), *l = find(Segment::kMiddle), *e = find(Segment::kEnd);
  if (!u || !l || !e) return std::nullopt;
  return makeLimb(setup, root, {u->source.front(), l->source.front(), e->source.front(), {}, {}, {}},
                  {u->target.front(), l->target.front(), e->target.front(), {}, {}, {}});
}

}  // namespace limber
