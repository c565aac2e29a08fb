#include "limber/rigging/figure/limb_finder.h"

#include <algorithm>

#include "limber/core/parallel.h"
#include "limber/rigging/figure/best_apart.h"
#include "limber/rigging/figure/steady.h"

namespace limber {

namespace {

constexpr int kLimbDirections = 160;
constexpr double kShortest = 0.85, kLongest = 1.15;  // lower bones against the proportions'
constexpr double kSameDirection = 0.985;
constexpr std::size_t kMaxLowers = 20;         // that begin at one position
constexpr std::size_t kMaxDirections = 4;      // of these that a limb is tried with
constexpr double kMinMatch = -0.1;             // of a lower bone
constexpr double kThinnest[] = {0.012, 0.02};  // statures, of the body at elbows, at knees
constexpr double kMaxStretch = 1.35, kMinStretch = 0.65;
constexpr double kMaxShoulderShift = 0.03;  // statures by which a shoulder may move
constexpr double kLimbInTrunk = 0.25;
constexpr double kApartMiddles = 0.035;  // statures between elbows or knees that are looked at
constexpr double kAlikeLimbMiddle = 0.04, kAlikeLimbAnkle = 0.06;
constexpr std::size_t kMoreLooked = 6;  // candidates, before hands and feet are looked at
constexpr double kFootYaws[] = {-0.6, -0.3, 0, 0.3, 0.6}, kFootPitches[] = {-0.3, 0.1, 0.5, 0.9};

}  // namespace

LimbFinder::LimbFinder(const BodyVolume& body, const FigureMatch& match, double stature)
    : body_(body), match_(match), stature_(stature) {
  for (const bool leg : {false, true}) {
    std::vector<std::vector<Lower>>& lowers = lowers_[leg];
    lowers.resize(body.spheres.size());
    parallelFor(lowers.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) lowers[s] = lowersAt(body_.spheres[s], leg);
    });
  }
}

std::vector<LimbFinder::Lower> LimbFinder::lowersAt(const MedialSphere& sphere, bool leg) const {
  std::vector<Lower> lowers;
  if (sphere.radius < kThinnest[leg] * stature_) return lowers;
  const int limb = leg ? 2 : 0;
  const double length = lowerLength(limb) * stature_;
  const auto add = [&](const Vec3& displacement, double scale) {
    if (body_.distance->at(sphere.center + 0.5 * scale * length * displacement) > 0) return;
    const double match = match_.lower(limb, sphere.center, displacement, scale * length, stature_);
    if (match > kMinMatch) lowers.push_back({displacement, scale, match});
  };
  for (const MedialSphere& other : body_.spheres) {
    const Vec3 displacement = other.center - sphere.center;
    const double scale = displacement.norm() / length;
    if (scale > kShortest && scale < kLongest) add(displacement.normalized(), scale);
  }
  // Some end where no sphere is.
  static const std::vector<Vec3> kDirections = evenDirections(kLimbDirections);
  for (const Vec3& displacement : kDirections) {
    if (body_.distance->at(sphere.center + 0.95 * length * displacement) < 0) add(displacement, 1);
  }
  return bestApart(
      std::move(lowers), kMaxLowers, [](const Lower& lower) { return lower.match; },
      [](const Lower& a, const Lower& b) { return a.direction.dot(b.direction) > kSameDirection; });
}

std::vector<LimbFinder::Upper> LimbFinder::uppersOf(const Figure& figure, int limb, std::size_t most) const {
  const Mat3& trunk = figure.trunkOf(limb);
  const double size = figure.stature, length = upperLength(limb) * size;
  const Vec3 socket = figure.socket(limb);
  Figure trial = figure;
  FigureLimb& bones = trial.limbs[limb];
  std::vector<Upper> uppers;
  for (std::size_t s = 0; s < body_.spheres.size(); ++s) {
    if (lowers_[isLeg(limb)][s].empty()) continue;
    const Vec3 displacement = body_.spheres[s].center - socket;
    double reach = displacement.norm();
    if (reach > kMaxStretch * length || reach < kMinStretch * length) continue;
    bones = {};
    bones.upper = displacement / reach;
    if (!upperAllowed(trunk, limb, bones.upper)) continue;
    if (!isLeg(limb)) {  // the shoulder moves where the bone would be too long or too short
      const double give = std::clamp(reach - length, -kMaxShoulderShift * size, kMaxShoulderShift * size);
      bones.shift = give / size * (trunk.transpose() * bones.upper);
      reach -= give;
    }
    bones.upperScale = reach / length;
    uppers.push_back({s, bones, match_.upper(trial, limb) - strain(trial, limb) - match_.pinCost(trial, limb, true)});
  }
  return bestApart(
      std::move(uppers), most, [](const Upper& upper) { return upper.match; },
      [&](const Upper& a, const Upper& b) {
        const Vec3 &first = body_.spheres[a.sphere].center, &second = body_.spheres[b.sphere].center;
        return (first - second).norm() < kApartMiddles * size;
      });
}

Vec3 LimbFinder::bestFoot(const Figure& figure, int limb, bool turned) const {
  const Vec3 down = figure.limbs[limb].lower;
  const Vec3 forward = toesForward(figure, limb).normalized(), aside = down.cross(forward);
  const Vec3 ankle = figure.positions(limb).ankle;
  Vec3 best = forward;
  double most = -1e9;
  for (const double yaw : kFootYaws) {
    if (yaw != 0 && !turned) continue;
    const SteadyAngle turn(yaw);
    const Vec3 level = turn.cos * forward + turn.sin * aside;
    for (const double pitch : kFootPitches) {
      const SteadyAngle tilt(pitch);
      const Vec3 foot = tilt.cos * level + tilt.sin * down;
      const double match = match_.foot(figure, ankle, foot);
      if (match <= most) continue;
      most = match;
      best = foot;
    }
  }
  return best;
}

std::vector<LimbFinder::Candidate> LimbFinder::find(const Figure& figure, int limb, const Effort& effort) const {
  const LimbWeights& weights = weightsOf(limb);
  Figure trial = figure;
  std::vector<Candidate> all;
  for (const Upper& upper : uppersOf(figure, limb, effort.middles)) {
    std::size_t count = 0;
    for (const Lower& lower : lowers_[isLeg(limb)][upper.sphere]) {
      FigureLimb& bones = trial.limbs[limb];
      bones = upper.bones;
      bones.lower = bones.end = lower.direction;
      bones.lowerScale = lower.scale * stature_ / figure.stature;
      if (isLeg(limb)) bones.end = toesForward(trial, limb).normalized();
      if (!limbAllowed(trial, limb)) continue;
      if (++count > kMaxDirections) break;
      const LimbPositions positions = trial.positions(limb);
      const double inside = match_.insideTrunk(figure, positions.ankle) +
                            match_.insideTrunk(figure, 0.5 * (positions.middle + positions.ankle));
      all.push_back({bones, weights.upper * upper.match + weights.lower * lower.match - kLimbInTrunk * inside -
                                match_.pinCost(trial, limb)});
    }
  }
  const auto matchOf = [](const Candidate& candidate) { return candidate.match; };
  const auto positions = [&](const Candidate& candidate) {
    trial.limbs[limb] = candidate.bones;
    return trial.positions(limb);
  };
  const auto isAlike = [&](const Candidate& a, const Candidate& b) {
    return alike(positions(a), positions(b), kAlikeLimbMiddle * figure.stature, kAlikeLimbAnkle * figure.stature);
  };
  std::vector<Candidate> apart = bestApart(std::move(all), effort.most + kMoreLooked, matchOf, isAlike);
  for (Candidate& candidate : apart) {
    trial.limbs[limb] = candidate.bones;
    if (isLeg(limb)) candidate.bones.end = trial.limbs[limb].end = bestFoot(trial, limb, effort.turnFeet);
    candidate.match = match_.limb(trial, limb);
  }
  return bestOf(std::move(apart), effort.most, matchOf);
}

}  // namespace limber
