#include "limber/character/matching/animal_legs.h"

#include <algorithm>
#include <cmath>

#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// Mean height over mean distance along the ground; 0.2 to 0.5; a snake's is less, a bird's more whatever its wings; set
// by hand.
constexpr double kStandingHeight = 0.3;

constexpr Index kMaxPairs = 2;  // pairs; 2 alone (hind and fore); that are solved for; more go by their joint angles

// The matched joints of one leg, hip to toes.
struct MatchedLeg {
  std::vector<const JointMatch*> bones;  // from the hip to before the foot
  const JointMatch *end = nullptr, *toes = nullptr;
};

MatchedLeg matchedLeg(const SkeletonMap& map, Side side, Index pair) {
  MatchedLeg leg;
  for (const JointMatch& match : map.matches) {
    if (match.part.kind != PartKind::kLeg || match.part.side != side || match.part.pair != pair) continue;
    if (match.part.segment == Segment::kEnd) leg.end = &match;
    if (match.part.segment == Segment::kToes) leg.toes = &match;
    const bool bone = match.part.segment == Segment::kUpper || match.part.segment == Segment::kMiddle ||
                      match.part.segment == Segment::kHock;
    if (bone) leg.bones.push_back(&match);
  }
  std::stable_sort(leg.bones.begin(), leg.bones.end(),
                   [](const JointMatch* a, const JointMatch* b) { return a->part < b->part; });
  return leg;
}

// Where the foot hangs elsewhere: the leg's last joint, that it rides on.
std::optional<Index> carrierOf(const Skeleton& skeleton, Index lower, const std::vector<Index>& last, Index end) {
  return isAncestorOrSelf(skeleton, lower, end) ? std::nullopt : std::optional(last.back());
}

// In mean heights of the matched joints, over the lowest of them; set by hand.
struct StandingLeg {
  double low = 0.2;      // 0.1 to begins; of where a leg rests, at most
  double begins = 0.35;  // low to 0.7; of its hip or shoulder, at least
  double steep = 1;      // slope, down over along; 0.5 to 2; of a leg, at least (45 degrees); set by hand
};
constexpr StandingLeg kStandingLeg;

struct HeightsOf {
  const SkeletonMap& map;
  MapSide side;
  const NeutralPose& neutral;
  double lowest = HUGE_VAL, height = 1;

  HeightsOf(const SkeletonMap& all, MapSide which, const NeutralPose& pose) : map(all), side(which), neutral(pose) {
    for (const Index joint : matchedJoints(all, which)) lowest = std::min(lowest, pose.positions[joint].y());
    height = bodySize(all, which, pose).height;
  }
  double over(Index joint) const { return (neutral.positions[joint].y() - lowest) / height; }
  bool isSteep(Index from, Index to) const {
    const Vec3 offset = neutral.positions[to] - neutral.positions[from];
    return -offset.y() > kStandingLeg.steep * std::hypot(offset.x(), offset.z());
  }
};

// Whether it comes down from the body to the ground in both.
bool isStanding(const AnimalLeg& leg, const HeightsOf& source, const HeightsOf& target) {
  return std::max(source.over(leg.source.end), target.over(leg.target.end)) < kStandingLeg.low &&
         std::max(source.over(leg.source.upper), target.over(leg.target.upper)) >= kStandingLeg.begins &&
         source.isSteep(leg.source.upper, leg.source.end) && target.isSteep(leg.target.upper, leg.target.end);
}

std::optional<AnimalLeg> legOf(const MatchedLeg& leg, const Skeleton& source, const Skeleton& target,
                               const NeutralPose& targetNeutral) {
  if (leg.bones.size() < 2 || !leg.end) return std::nullopt;
  const std::vector<Vec3>& to = targetNeutral.positions;
  const JointMatch& upper = *leg.bones.front();
  const Vec3 start = to[upper.target.front()], line = (to[leg.end->target.front()] - start).normalized();
  const auto offLine = [&](const JointMatch* bone) { return (to[bone->target.front()] - start).cross(line).norm(); };
  // The joint between that bends it most, and the one that bends it most after that.
  std::vector<const JointMatch*> between(leg.bones.begin() + 1, leg.bones.end());
  std::stable_sort(between.begin(), between.end(),
                   [&](const JointMatch* a, const JointMatch* b) { return offLine(a) > offLine(b); });
  AnimalLeg found;
  found.source = {upper.source.front(), between[0]->source.front(), leg.end->source.front(), {}, {}, {}};
  found.target = {upper.target.front(), between[0]->target.front(), leg.end->target.front(), {}, {}, {}};
  if (between.size() > 1) {
    found.source.hock = between[1]->source.front();
    found.target.hock = between[1]->target.front();
  }
  if (leg.toes) {
    found.source.toes = leg.toes->source.front();
    found.target.toes = leg.toes->target.front();
  }
  found.source.carrier = carrierOf(source, found.source.upper, leg.bones.back()->source, found.source.end);
  found.target.carrier = carrierOf(target, found.target.upper, leg.bones.back()->target, found.target.end);
  return found;
}

}  // namespace

bool BodySize::isStanding() const {
  return height > kStandingHeight * spread;
}

BodySize bodySize(const SkeletonMap& map, MapSide side, const NeutralPose& neutral) {
  Box box;
  BodySize size;
  const std::vector<Index> joints = matchedJoints(map, side);
  const double fraction = 1 / static_cast<double>(joints.size());
  Vec3 middle = Vec3::Zero();
  for (const Index joint : joints) {
    box.add(neutral.restPositions[joint]);
    middle += fraction * neutral.restPositions[joint];
  }
  for (const Index joint : joints) {
    const Vec3 offset = neutral.restPositions[joint] - middle;
    size.spread += fraction * std::hypot(offset.x(), offset.z());
  }
  size.height = middle.y() - box.min.y();
  size.across = box.diagonal();
  return size;
}

std::vector<AnimalLeg> animalLegs(const SkeletonMap& map, const Skeleton& source, const Skeleton& target,
                                  const NeutralPose& sourceNeutral, const NeutralPose& targetNeutral) {
  std::vector<AnimalLeg> legs;
  const bool stand = bodySize(map, MapSide::kSource, sourceNeutral).isStanding() &&
                     bodySize(map, MapSide::kTarget, targetNeutral).isStanding();
  if (!map.isQuadruped() && !stand) return legs;
  Index pairs = 0;
  for (const JointMatch& match : map.matches) {
    if (match.part.kind == PartKind::kLeg) pairs = std::max(pairs, match.part.pair + 1);
  }
  if (pairs > kMaxPairs) return legs;
  const HeightsOf from(map, MapSide::kSource, sourceNeutral), to(map, MapSide::kTarget, targetNeutral);
  for (Index pair = 0; pair < pairs; ++pair) {
    for (const Side side : kSides) {
      std::optional<AnimalLeg> leg = legOf(matchedLeg(map, side, pair), source, target, targetNeutral);
      if (!leg || (pairs == 1 && !isStanding(*leg, from, to))) continue;
      leg->fore = pair == 0 && pairs > 1;
      legs.push_back(*leg);
    }
  }
  for (AnimalLeg& leg : legs) {
    leg.footDriven = legs.size() == 2 || map.isQuadruped() || (leg.source.carrier && leg.target.carrier);
  }
  return legs;
}

}  // namespace limber
