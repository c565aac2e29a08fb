#include "limber/motion/limbs/body/trunk_tilt.h"

#include <cmath>

#include "limber/motion/limbs/smooth.h"

namespace limber {

namespace {

Vec3 offsetBetween(const std::vector<Index>& from, const std::vector<Index>& to, const std::vector<Vec3>& positions) {
  return middleOf(to, positions) - middleOf(from, positions);
}

// Of a trunk as long as 1 that rises by that; past the vertical it goes on evenly.
double slopeOf(double rise) {
  return straightenedAsin(rise, kMaxExactSine);
}

}  // namespace

TrunkTilt::TrunkTilt(const RetargetSetup& setup, const RootPositioner& root) : setup_(setup), root_(root) {
  if (setup.rootFollows != RootFollows::kHindquarters || !root.turnsPelvis()) return;
  for (const AnimalLeg& leg : setup.animalLegs) {
    (leg.fore ? shoulders_ : hips_).push_back(leg.target.upper);
    (leg.fore ? sourceShoulders_ : sourceHips_).push_back(leg.source.upper);
  }
  if (hips_.empty()) shoulders_.clear();
}

void TrunkTilt::follow(const BodyFrame& source, Pose& target, BodyFrame& frame) const {
  if (!tilts()) return;
  const Vec3 sourceOffset = offsetBetween(sourceHips_, sourceShoulders_, source.positions) -
                            offsetBetween(sourceHips_, sourceShoulders_, setup_.sourceNeutral.restPositions);
  const Vec3 trunk = trunkOf(frame);
  const Vec3 displacement = trunk - offsetBetween(hips_, shoulders_, setup_.targetNeutral.restPositions);
  root_.turnPelvis(turnFor(setup_.scale * sourceOffset.y() - displacement.y(), trunk), target, frame);
}

Vec3 TrunkTilt::trunkOf(const BodyFrame& frame) const {
  return offsetBetween(hips_, shoulders_, frame.positions);
}

Quat TrunkTilt::turnFor(double rise, const Vec3& trunk) {
  const Vec3 aside = trunk.cross(Vec3::UnitY());
  const double length = trunk.norm();
  if (!(aside.norm() > 1e-6 * length)) return Quat::Identity();
  const double up = slopeOf((trunk.y() + rise) / length) - slopeOf(trunk.y() / length);
  return Quat(Eigen::AngleAxisd(up, aside.normalized()));
}

Vec3 TrunkTilt::liftOf(const Vec3& trunk) {
  const Vec3 level(trunk.x(), 0, trunk.z());
  if (!(level.norm() > 0.1 * trunk.norm())) return Vec3::UnitY();
  return Vec3::UnitY() - trunk.y() / level.squaredNorm() * level;
}

}  // namespace limber
