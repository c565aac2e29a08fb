#include "limber/motion/limbs/limb.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/limbs/contacts/foot_pitch.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// Of the legs of a kind of body.
struct LegValues {
  // Lengths of the line from hip to ankle; 0.002 to 0.03; a knee of an animal that is further off it tells to which
  // side it bends; set by hand.
  double bentInRest = 0.01;

  // Hip heights a second; 0.3 to 1, 0.2 to 0.8 of upright bodies (set on a dinosaur's clips on people); else set by
  // hand on farm animals' clips on each other; FootDrive::slipSpeed.
  double slipSpeed = 0.65, uprightSlipSpeed = 0.4;

  // Of upright bodies, BodySupport::carried upwards; fraction; 0 to 1; by jerk on all 528 shared pairs of a motion and
  // a person (0.7 before).
  double carriedUp = 0.5;
  // BodySupport::softStretch, hip heights; 0.005 to 0.03; by jerk on the shared people. Of legs at both ends of a body
  // and of foot-driven ones, some of which are far off and stretch more: 0.02 to 0.08; set on a dinosaur's clips on
  // people.
  double softStretch = 0.015, softFar = 0.04;
  // BodySupport::maxSink of hips or shoulders alone, hip heights; 0.05 to 0.3; before feet that cannot reach lift; set
  // on a fox's gallop on an alpaca, which reared without it.
  double maxSinkAtEnd = 0.15;
  // Fraction of LimbSpec::folded; 0.5 to 1; BodySupport::nearest of knees that follow joint angles; set by hand on
  // boxing and bending.
  double kneesFold = 0.75;
  // BodySupport::nearLevel of the foot-driven legs of an upright body; 0.1 to 0.5; set on a dinosaur's clips on people.
  double nearLevel = 0.3;
};
constexpr LegValues kLegValues;

// How far the lower joint is off the line from the upper one to the end, in lengths of that line.
Vec3 bendAtRest(const LegJoints& leg, const NeutralPose& neutral) {
  const Vec3 upper = neutral.positions[leg.upper], line = neutral.positions[leg.end] - upper;
  const Vec3 lower = neutral.positions[leg.lower] - upper;
  return (lower - lower.dot(line) / line.squaredNorm() * line) / line.norm();
}

// The source's joint that carries this leg and another.
std::optional<Index> sourceBodyOf(const AnimalLeg& leg, const RetargetSetup& setup) {
  const Skeleton& source = *setup.source;
  const auto carriesOther = [&](Index joint) {
    return std::any_of(setup.animalLegs.begin(), setup.animalLegs.end(), [&](const AnimalLeg& other) {
      return other.source.upper != leg.source.upper && isAncestorOrSelf(source, joint, other.source.upper);
    });
  };
  std::optional<Index> body = source.joints[leg.source.upper].parent;
  while (body && !carriesOther(*body)) body = source.joints[*body].parent;
  return body;
}

LegSpec legOf(const LimbSpec& limb) {
  LegSpec leg;
  static_cast<LimbSpec&>(leg) = limb;
  return leg;
}

// Once its joints are known.
void measureFoot(const RetargetSetup& setup, LegSpec& leg) {
  const auto sourceGround = [&](Index joint) {
    return setup.sourceGround + setup.sourceNeutral.positions[joint].y() - setup.sourceLowest;
  };
  const auto targetGround = [&](Index joint) {
    return setup.targetGround + setup.targetNeutral.positions[joint].y() - setup.targetLowest;
  };
  leg.ankleGround = targetGround(leg.end);
  leg.sourceAnkleGround = sourceGround(leg.sourceEnd);
  if (leg.toes) {
    leg.toesGround = targetGround(*leg.toes);
    leg.sourceToesGround = sourceGround(*leg.sourceToes);
  }
  if (leg.tip) leg.toesGround = targetGround(*leg.tip);
  leg.footPitch = footPitchFraction(setup, leg);
}

std::optional<LegSpec> uprightLeg(const RetargetSetup& setup, const RootPositioner& root, Side side) {
  const std::optional<LimbSpec> limb = findLimb(setup, root, PartKind::kLeg, side);
  if (!limb) return std::nullopt;
  LegSpec leg = legOf(*limb);
  leg.kneeAhead = Vec3::UnitZ();
  leg.plantigrade = true;
  if (const JointMatch* toes = setup.map.find(body_part::leg(side, Segment::kToes))) {
    leg.toes = toes->target.front();
    leg.sourceToes = toes->source.front();
  } else {
    leg.tip = toesOf(*setup.target, setup.map, MapSide::kTarget, side, setup.targetNeutral.restPositions);
  }
  measureFoot(setup, leg);
  leg.support = {.carried = Vec3(1, kLegValues.carriedUp, 1),
                 .softStretch = kLegValues.softStretch,
                 .maxSink = kMaxSink,
                 .risesAtOnce = true,
                 .nearest = kLegValues.kneesFold * leg.folded};
  const JointMatch &shin = *setup.map.find(body_part::leg(side, Segment::kMiddle)),
                   &hips = *setup.map.find(body_part::kPelvis);
  if (!isBent(shin.source, leg.sourceEnd, setup.sourceNeutral.restPositions)) return leg;
  const LegJoints from = {leg.sourceUpper, shin.source.front(), leg.sourceEnd, {}, {}, {}};
  const LegJoints to = {leg.upper, leg.lower, leg.end, {}, {}, {}};
  leg.drive = {.bend = LegBend(setup, from, to),
               .sourceBody = hips.source.back(),
               .uprightBody = true,
               .restHeight = leg.ankleGround,
               .sourceRestHeight = leg.sourceAnkleGround,
               .slipSpeed = kLegValues.uprightSlipSpeed};
  leg.support.carried.setZero();
  leg.support.nearest = leg.folded;
  leg.support.nearLevel = kLegValues.nearLevel;
  return leg;
}

std::vector<LegSpec> uprightLegs(const RetargetSetup& setup, const RootPositioner& root) {
  std::vector<LegSpec> legs;
  for (const Side side : kSides) {
    if (const std::optional<LegSpec> leg = uprightLeg(setup, root, side)) legs.push_back(*leg);
  }
  // One body follows all of them.
  if (std::any_of(legs.begin(), legs.end(), [](const LegSpec& leg) { return leg.drive.has_value(); })) {
    for (LegSpec& leg : legs) {
      leg.support.softStretch = kLegValues.softFar;
      leg.support.sinksSoftly = true;
    }
  }
  return legs;
}

std::optional<LegSpec> legUnderTrunk(const RetargetSetup& setup, const RootPositioner& root, const TrunkTilt& trunk,
                                     const AnimalLeg& found) {
  const std::optional<LimbSpec> limb = makeLimb(setup, root, found.source, found.target);
  if (!limb) return std::nullopt;
  LegSpec leg = legOf(*limb);
  const Vec3 ahead = bendAtRest(found.target, setup.targetNeutral);
  leg.kneeAhead = ahead.norm() > kLegValues.bentInRest ? ahead.normalized() : Vec3(Vec3::UnitZ());
  leg.hock = found.target.hock;
  leg.fore = trunk.tilts() && found.fore;
  leg.ownBend =
      found.footDriven || bendAtRest(found.source, setup.sourceNeutral).dot(*leg.kneeAhead) < kLegValues.bentInRest;
  leg.toes = found.target.toes;
  leg.sourceToes = found.source.toes;
  measureFoot(setup, leg);
  const double maxSink = trunk.tilts() ? kLegValues.maxSinkAtEnd : kMaxSink;
  leg.support = {.softStretch = kLegValues.softFar, .maxSink = maxSink, .sinksSoftly = trunk.tilts()};
  if (!found.footDriven) return leg;
  leg.drive = {.bend = LegBend(setup, found.source, found.target),
               .sourceBody = sourceBodyOf(found, setup),
               .restHeight = setup.targetNeutral.restPositions[leg.end].y(),
               .sourceRestHeight = setup.sourceNeutral.restPositions[leg.sourceEnd].y(),
               .slipSpeed = kLegValues.slipSpeed};
  leg.support.carried.setZero();
  leg.support.risesAtOnce = true;
  if (!leg.hock) leg.support.nearest = leg.folded;  // hocks fold as well
  return leg;
}

}  // namespace

std::optional<LimbSpec> makeLimb(const RetargetSetup& setup, const RootPositioner& root, const LegJoints& source,
                                 const LegJoints& target) {
  LimbSpec limb;
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

std::optional<LimbSpec> findLimb(const RetargetSetup& setup, const RootPositioner& root, PartKind kind, Side side) {
  const auto find = [&](Segment segment) { return setup.map.find({kind, side, 0, segment, 0}); };
  const JointMatch *u = find(Segment::kUpper), *l = find(Segment::kMiddle), *e = find(Segment::kEnd);
  if (!u || !l || !e) return std::nullopt;
  return makeLimb(setup, root, {u->source.front(), l->source.front(), e->source.front(), {}, {}, {}},
                  {u->target.front(), l->target.front(), e->target.front(), {}, {}, {}});
}

std::optional<LimbSpec> findArm(const RetargetSetup& setup, const RootPositioner& root, Side side) {
  return setup.person ? findLimb(setup, root, PartKind::kArm, side) : std::nullopt;
}

std::vector<LegSpec> findLegs(const RetargetSetup& setup, const RootPositioner& root, const TrunkTilt& trunk) {
  if (setup.person) return uprightLegs(setup, root);
  std::vector<LegSpec> legs;
  for (const AnimalLeg& found : setup.animalLegs) {
    if (const std::optional<LegSpec> leg = legUnderTrunk(setup, root, trunk, found)) legs.push_back(*leg);
  }
  std::stable_partition(legs.begin(), legs.end(), [](const LegSpec& leg) { return !leg.fore; });
  return legs;
}

}  // namespace limber
