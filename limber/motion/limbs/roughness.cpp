#include "limber/motion/limbs/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "limber/skeleton/chain.h"

namespace limber {

namespace {

struct JerkLimits {
  // Standing heights a second; 8 to 20; a joint that is faster is cut; set by hand.
  double cut = 12;
  // Root mean square third difference of a path, dimensionless; 1e-6 to 1e-4; less counts as it: rounding only.
  double minJerk = 2e-5;
  // Weight of squared third differences against squared changes; 1e8 to 1e11; more is lost in rounding (at 300 frames a
  // second); rounding only.
  double smoothest = 1e10;
};
constexpr JerkLimits kJerkLimits;

// Each two matched joints of which one hangs on the other in both, and chains from end to end, as bones.
std::vector<LimbPair> matchedBones(const RetargetSetup& setup) {
  std::vector<const JointMatch*> from(setup.source->jointCount()), to(setup.target->jointCount());
  for (const JointMatch& match : setup.map.matches) {
    for (const Index joint : match.source) from[joint] = &match;
    for (const Index joint : match.target) to[joint] = &match;
  }
  std::vector<LimbPair> bones;
  const auto add = [&](const LimbPair& bone) {
    const auto hasLength = [](const NeutralPose& pose, const std::vector<Index>& joints) {
      return (pose.restPositions[joints[1]] - pose.restPositions[joints[0]]).norm() > 0;
    };
    if (hasLength(setup.sourceNeutral, bone.source) && hasLength(setup.targetNeutral, bone.target)) {
      bones.push_back(bone);
    }
  };
  for (const JointMatch& match : setup.map.matches) {
    const Index s = match.source.front(), t = match.target.front();
    const std::optional<Index> one = nearestAbove(*setup.source, s, [&](Index j) { return from[j]; });
    const std::optional<Index> other = nearestAbove(*setup.target, t, [&](Index j) { return to[j]; });
    if (one && other && from[*one] == to[*other]) add({{*one, s}, {*other, t}});
    if (match.source.size() > 1 && match.target.size() > 1) add({{s, match.source.back()}, {t, match.target.back()}});
  }
  return bones;
}

}  // namespace

bool hasLegs(const RetargetSetup& setup) {
  return setup.person || !setup.animalLegs.empty();
}

std::vector<LimbPair> limbPairs(const RetargetSetup& setup) {
  if (!hasLegs(setup)) return matchedBones(setup);
  std::vector<LimbPair> limbs;
  for (const PartKind kind : {PartKind::kArm, PartKind::kLeg}) {
    for (const Side side : kSides) {
      if (!setup.person) break;
      LimbPair& limb = limbs.emplace_back();
      for (const Segment segment : {Segment::kUpper, Segment::kMiddle, Segment::kEnd}) {
        const JointMatch* match = setup.map.find({kind, side, 0, segment, 0});
        if (!match) continue;
        limb.source.push_back(match->source.front());
        limb.target.push_back(match->target.front());
      }
    }
  }
  for (const AnimalLeg& leg : setup.animalLegs) {
    limbs.push_back(
        {{leg.source.upper, leg.source.lower, leg.source.end}, {leg.target.upper, leg.target.lower, leg.target.end}});
  }
  return limbs;
}

double standingHeight(const RetargetSetup& setup, MapSide side) {
  const bool source = side == MapSide::kSource;
  if (!hasLegs(setup)) return source ? setup.sourceHipHeight : setup.targetHipHeight;
  const std::vector<Vec3>& positions = (source ? setup.sourceNeutral : setup.targetNeutral).positions;
  double high = pelvisOf(setup.map, side, positions).y();
  for (const JointMatch& match : setup.map.matches) {
    const bool isUpright =
        match.part == body_part::kTrunk || match.part == body_part::kNeck || match.part == body_part::kHead;
    if (setup.person && !isUpright) continue;
    high = std::max(high, positions[(source ? match.source : match.target).back()].y());
  }
  return high - (source ? setup.sourceLowest : setup.targetLowest);
}

BodyPaths::BodyPaths(const RetargetSetup& setup, MapSide side, const std::vector<Vec3>& rest)
    : setup_(&setup), side_(side) {
  for (const LimbPair& limb : limbPairs(setup)) {
    const std::vector<Index>& joints = limb.of(side);
    for (std::size_t i = 1; i < joints.size(); ++i) {
      bones_.push_back({joints[i - 1], joints[i], (rest[joints[i]] - rest[joints[i - 1]]).norm()});
    }
  }
  paths_.resize(1 + bones_.size());
}

void BodyPaths::add(const std::vector<Vec3>& positions) {
  const double hips = side_ == MapSide::kSource ? setup_->sourceHipHeight : setup_->targetHipHeight;
  paths_[0].push_back(pelvisOf(setup_->map, side_, positions) / hips);
  for (std::size_t b = 0; b < bones_.size(); ++b) {
    paths_[b + 1].push_back((positions[bones_[b].to] - positions[bones_[b].from]) / bones_[b].length);
  }
}

bool isCut(const RetargetSetup& setup, const std::vector<Vec3>& before, const std::vector<Vec3>& now, double seconds) {
  const double most = kJerkLimits.cut * standingHeight(setup, MapSide::kSource) * seconds;
  return std::any_of(setup.map.matches.begin(), setup.map.matches.end(), [&](const JointMatch& match) {
    return (now[match.source.front()] - before[match.source.front()]).norm() > most;
  });
}

bool isWhole(const std::vector<bool>& cuts, std::size_t f) {
  return f >= 3 && !cuts[f] && !cuts[f - 1] && !cuts[f - 2];
}

Vec3 thirdDifference(const Path& path, std::size_t f) {
  return path[f] - path[f - 3] - 3 * (path[f - 1] - path[f - 2]);
}

double squaredJerk(const Path& path, const std::vector<bool>& cuts, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t f = begin; f < end; ++f) {
    if (isWhole(cuts, f)) sum += thirdDifference(path, f).squaredNorm();
  }
  return sum;
}

double squaredJerk(const std::vector<Path>& paths, const std::vector<bool>& cuts, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (const Path& path : paths) sum += squaredJerk(path, cuts, begin, end);
  return sum;
}

double jerkRatio(double source, double target, std::size_t frames) {
  const double least = kJerkLimits.minJerk * kJerkLimits.minJerk * static_cast<double>(frames);
  return target > least || source > least ? std::sqrt(target / std::max(source, least)) : 1;
}

double smoothnessWeight(double seconds, double frameSeconds) {
  return std::min(std::pow(seconds / frameSeconds, 6), kJerkLimits.smoothest);
}

}  // namespace limber
