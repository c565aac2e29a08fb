#include "limber/motion/limbs/body/body_lift.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/limbs/smooth.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// In hip heights of the target; set by hand on a dog that falls over as a horse (it lay 13 cm too deep before).
struct Lifting {
  double lies = 0.2;   // 0.1 to 0.3; a joint lower than that stays as high as the source's, scaled
  double soft = 0.04;  // 0.02 to 0.1; over which that begins, and joints take over, without a kink
  double max = 2;      // 1 to 20; lacks above it count alike, so that exp() stays finite
};
constexpr Lifting kLifting;

}  // namespace

BodyLift::BodyLift(const RetargetSetup& setup) : setup_(setup) {
  const Skeleton& target = *setup.target;
  const auto carriesLeg = [&](Index joint) {
    return std::any_of(setup.animalLegs.begin(), setup.animalLegs.end(),
                       [&](const AnimalLeg& leg) { return isAncestorOrSelf(target, joint, leg.target.upper); });
  };
  for (const JointMatch& match : setup.map.matches) {
    if (!target.joints[match.target.front()].parent) continue;  // may lie on the ground by itself
    if (carriesLeg(match.target.front())) body_.push_back({match.source.front(), match.target.front()});
  }
}

void BodyLift::apply(const BodyFrame& source, const RootPositioner& root, Pose& target, BodyFrame& frame) const {
  if (setup_.animalLegs.empty()) return;
  root.movePelvis(Vec3(0, (*this)(source, frame), 0), target, frame);
}

double BodyLift::operator()(const BodyFrame& source, const BodyFrame& target) const {
  const double height = setup_.targetHipHeight;
  double sum = 0, weights = 0;
  for (const Pair& pair : body_) {
    const double over = setup_.scale * (source.positions[pair.source].y() - setup_.sourceGround) / height;
    const double goal = kLifting.lies - softPositive(kLifting.lies - over, kLifting.soft);
    const double is = (target.positions[pair.target].y() - setup_.targetGround) / height;
    const double lacks = softPositive(goal - is, kLifting.soft);
    const double weight = std::exp(std::min(lacks, kLifting.max) / kLifting.soft);
    sum += weight * lacks;
    weights += weight;
  }
  // The most, but without a kink where another joint takes over.
  return weights > 0 ? height * sum / weights : 0;
}

}  // namespace limber
