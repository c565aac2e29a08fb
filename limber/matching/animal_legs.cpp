#include "limber/matching/animal_legs.h"

#include <algorithm>
#include <cmath>

#include "limber/matching/loose_feet.h"
#include "limber/matching/quadruped_shape.h"

namespace limber {

namespace {

constexpr double kStands = 0.3;  // mean height, in mean distances along the ground: a snake's is less

// In mean heights of the joints.
constexpr double kLow = 0.2;      // of a leg's end, at most
constexpr double kBegins = 0.35;  // of its upper joint, at least
constexpr double kSteep = 1;      // how far down it goes for each metre along, at least: tails and necks do not

constexpr double kBlade = 0.7;  // of the height of a blade's upper end, at which its lower one is at least

// A joint of the target and its partner in the source.
struct Pair {
  Index source = 0, target = 0;
  std::optional<LegEnd> known;  // of quadrupeds matched by form
};

class LegFinder {
 public:
  LegFinder(const SkeletonMap& map, const Skeleton& source, const Skeleton& target, const NeutralPose& sourceNeutral,
            const NeutralPose& targetNeutral, double sourceHeight, double targetHeight)
      : source_(source),
        target_(target),
        sourceNeutral_(sourceNeutral),
        targetNeutral_(targetNeutral),
        sourceHeight_(sourceHeight),
        targetHeight_(targetHeight),
        sourceParents_(parentsWithLegsJoined(source, sourceNeutral.positions)),
        targetParents_(parentsWithLegsJoined(target, targetNeutral.positions)),
        pairOf_(target.jointCount()),
        matchedSource_(source.jointCount()) {
    // Joints may have the names of these parts.
    const bool byForm = map.find(kHindquarters);
    for (const JointMatch& match : map.matches) {
      const std::optional<LegEnd> legEnd = byForm ? legEndOf(match.part) : std::nullopt;
      pairs_.push_back({match.source.front(), match.target.front(), legEnd});
      pairOf_[match.target.front()] = pairs_.size() - 1;
      matchedSource_[match.source.front()] = true;
    }
    children_.resize(pairs_.size());
    above_.resize(pairs_.size());
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      above_[p] = pairAbove(pairs_[p]);
      if (above_[p]) children_[*above_[p]].push_back(p);
      sourceLowest_ = std::min(sourceLowest_, sourceNeutral.positions[pairs_[p].source].y());
      targetLowest_ = std::min(targetLowest_, targetNeutral.positions[pairs_[p].target].y());
    }
  }

  std::vector<AnimalLeg> find() const {
    std::vector<AnimalLeg> legs;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      if (!children_[p].empty()) continue;
      std::vector<Pair> chain = {pairs_[p]};
      for (auto above = above_[p]; above && children_[*above].size() == 1; above = above_[*above]) {
        chain.push_back(pairs_[*above]);
      }
      std::reverse(chain.begin(), chain.end());
      if (const std::optional<AnimalLeg> leg = legOf(chain)) legs.push_back(*leg);
    }
    return legs;
  }

 private:
  using Parents = std::vector<std::optional<Index>>;

  static std::optional<Index> nearestAbove(const Parents& parents, Index joint, const auto& isMatched) {
    std::optional<Index> at = parents[joint];
    while (at && !isMatched(*at)) at = parents[*at];
    return at;
  }

  // The nearest pair above in both.
  std::optional<std::size_t> pairAbove(const Pair& pair) const {
    const auto target = nearestAbove(targetParents_, pair.target, [&](Index j) { return pairOf_[j].has_value(); });
    const auto source = nearestAbove(sourceParents_, pair.source, [&](Index j) { return matchedSource_[j]; });
    if (!target || !source || pairs_[*pairOf_[*target]].source != *source) return std::nullopt;
    return pairOf_[*target];
  }

  // Over the lowest, in mean heights of the joints: the higher of both.
  double height(const Pair& pair) const {
    return std::max((sourceNeutral_.positions[pair.source].y() - sourceLowest_) / sourceHeight_,
                    (targetNeutral_.positions[pair.target].y() - targetLowest_) / targetHeight_);
  }

  static std::optional<Index> carrierOf(Index end, const Skeleton& skeleton, const Parents& parents) {
    return parents[end] == skeleton.joints[end].parent ? std::nullopt : parents[end];
  }

  static bool isSteep(const Vec3& way) { return -way.y() > kSteep * std::hypot(way.x(), way.z()); }

  // Where in a chain the leg begins and ends.
  struct Ends {
    std::size_t upper = 0, end = 0;
  };

  std::optional<Ends> endsOf(const std::vector<Pair>& chain) const {
    const auto where = [&](const auto& is) {
      return static_cast<std::size_t>(std::find_if(chain.begin(), chain.end(), is) - chain.begin());
    };
    const Ends known{where([](const Pair& p) { return p.known == LegEnd::kUpper; }),
                     where([](const Pair& p) { return p.known == LegEnd::kFoot; })};
    if (known.end < chain.size()) return known.upper + 2 <= known.end ? std::optional(known) : std::nullopt;
    Ends ends{0, where([&](const Pair& p) { return height(p) < kLow; })};
    if (ends.end < 2 || ends.end >= chain.size() || height(chain.back()) > kLow) return std::nullopt;
    // Shoulder blades and hip bones stay with the body.
    if (ends.end > 2 && height(chain[1]) > kBlade * height(chain[0])) ends.upper = 1;
    const Pair &begin = chain[ends.upper], &end = chain[ends.end];
    const bool steep = isSteep(sourceNeutral_.positions[end.source] - sourceNeutral_.positions[begin.source]) &&
                       isSteep(targetNeutral_.positions[end.target] - targetNeutral_.positions[begin.target]);
    return steep && height(begin) >= kBegins ? std::optional(ends) : std::nullopt;
  }

  std::optional<AnimalLeg> legOf(const std::vector<Pair>& chain) const {
    const std::optional<Ends> ends = endsOf(chain);
    if (!ends) return std::nullopt;
    const auto [upper, end] = *ends;
    const std::vector<Vec3>& to = targetNeutral_.positions;
    const Vec3 start = to[chain[upper].target], line = (to[chain[end].target] - start).normalized();
    const auto offLine = [&](const Pair& pair) { return (to[pair.target] - start).cross(line).norm(); };
    const auto lower = std::max_element(chain.begin() + static_cast<std::ptrdiff_t>(upper) + 1,
                                        chain.begin() + static_cast<std::ptrdiff_t>(end),
                                        [&](const Pair& a, const Pair& b) { return offLine(a) < offLine(b); });
    AnimalLeg leg;
    leg.source.upper = chain[upper].source;
    leg.source.lower = lower->source;
    leg.source.end = chain[end].source;
    leg.source.carrier = carrierOf(chain[end].source, source_, sourceParents_);
    leg.target.upper = chain[upper].target;
    leg.target.lower = lower->target;
    leg.target.end = chain[end].target;
    leg.target.carrier = carrierOf(chain[end].target, target_, targetParents_);
    double most = 0;
    for (std::size_t i = upper + 1; i < end; ++i) {
      if (chain[i].target == lower->target || offLine(chain[i]) <= most) continue;
      most = offLine(chain[i]);
      leg.source.hock = chain[i].source;
      leg.target.hock = chain[i].target;
    }
    if (end + 1 < chain.size()) {
      leg.source.toes = chain[end + 1].source;
      leg.target.toes = chain[end + 1].target;
    }
    return leg;
  }

  const Skeleton &source_, &target_;
  const NeutralPose &sourceNeutral_, &targetNeutral_;
  double sourceHeight_, targetHeight_;
  Parents sourceParents_, targetParents_;  // #J
  double sourceLowest_ = HUGE_VAL, targetLowest_ = HUGE_VAL;
  std::vector<Pair> pairs_;
  std::vector<std::optional<std::size_t>> pairOf_;  // #J of the target
  std::vector<bool> matchedSource_;                 // #J of the source
  std::vector<std::optional<std::size_t>> above_;   // #pairs
  std::vector<std::vector<std::size_t>> children_;  // #pairs
};

}  // namespace

bool BodySize::stands() const {
  return height > kStands * spread;
}

BodySize bodySize(const SkeletonMap& map, MapSide side, const NeutralPose& neutral) {
  Box box;
  BodySize size;
  const std::vector<Index> joints = matchedJoints(map, side);
  const double share = 1 / static_cast<double>(joints.size());
  Vec3 middle = Vec3::Zero();
  for (const Index joint : joints) {
    box.add(neutral.restPositions[joint]);
    middle += share * neutral.restPositions[joint];
  }
  for (const Index joint : joints) {
    const Vec3 way = neutral.restPositions[joint] - middle;
    size.spread += share * std::hypot(way.x(), way.z());
  }
  size.height = middle.y() - box.min.y();
  size.across = box.diagonal();
  return size;
}

std::vector<AnimalLeg> animalLegs(const SkeletonMap& map, const Skeleton& source, const Skeleton& target,
                                  const NeutralPose& sourceNeutral, const NeutralPose& targetNeutral) {
  const BodySize one = bodySize(map, MapSide::kSource, sourceNeutral),
                 other = bodySize(map, MapSide::kTarget, targetNeutral);
  if (!map.find(kHindquarters) && (!one.stands() || !other.stands())) return {};
  return LegFinder(map, source, target, sourceNeutral, targetNeutral, one.height, other.height).find();
}

}  // namespace limber
