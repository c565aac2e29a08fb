#include "limber/rigging/figure/figure.h"

#include <algorithm>

#include "limber/core/rotation.h"

namespace limber {

namespace {

constexpr double kFoldedCos = -0.88;   // between the bones of a limb folded as far as it goes
constexpr double kStraightSin = 0.12;  // of limbs so straight that they have no bend direction

// The part of `direction` square to `axis`.
Vec3 squareTo(const Vec3& axis, const Vec3& direction) {
  return direction - direction.dot(axis) * axis;
}

bool armAllowed(double out, double up, double front) {
  const bool behind = front < -0.75 || (up > 0.6 && front < -0.3);
  const bool across = out < -0.75 || (out < -0.2 && front < 0);
  return !behind && !across;
}

bool legAllowed(double out, double up, double front) {
  const bool behind = front < -0.55;
  const bool across = out < -0.45;
  const bool high = up > 0.55 || out > 0.9 || (up > 0.2 && front < 0.3);
  return !behind && !across && !high;
}

bool bendAllowed(const Figure& figure, int limb) {
  const FigureLimb& bones = figure.limbs[limb];
  if (bones.upper.dot(bones.lower) < kFoldedCos) return false;
  const Vec3 bend = squareTo(bones.upper, bones.lower);
  if (bend.norm() < kStraightSin) return true;
  const double most = isLeg(limb) ? 0.5 : -0.35;  // cosine of the turn in or out
  return bend.normalized().dot(bendDirection(figure, limb, bones.upper)) >= most;
}

bool footAllowed(const Figure& figure, int limb) {
  const FigureLimb& bones = figure.limbs[limb];
  const double along = bones.end.dot(bones.lower);
  if (along > 0.8 || along < -0.5) return false;
  const Vec3 toes = squareTo(bones.lower, bones.end), forward = toesForward(figure, limb);
  return forward.norm() < 1e-6 || toes.normalized().dot(forward.normalized()) > 0.55;
}

}  // namespace

double upperLength(int limb) {
  return isLeg(limb) ? proportions::kThigh : proportions::kUpperArm;
}

double lowerLength(int limb) {
  return isLeg(limb) ? proportions::kShank : proportions::kForearm;
}

Vec3 Figure::socket(int limb) const {
  if (isLeg(limb)) return hips() + sideOf(limb) * proportions::kHipHalf * stature * pelvis.col(0);
  return neckBase() + stature * (sideOf(limb) * proportions::kShoulderHalf * chest.col(0) -
                                 proportions::kShoulderDrop * chest.col(1));
}

LimbPositions Figure::positions(int limb) const {
  const FigureLimb& bones = limbs[limb];
  LimbPositions positions;
  positions.root = socket(limb);
  if (!isLeg(limb)) positions.root += stature * (chest * bones.shift);
  positions.middle = positions.root + bones.upperScale * upperLength(limb) * stature * bones.upper;
  positions.ankle = positions.middle + bones.lowerScale * lowerLength(limb) * stature * bones.lower;
  positions.tip = positions.ankle + (isLeg(limb) ? proportions::kFoot : proportions::kHand) * stature * bones.end;
  return positions;
}

Vec3 bendDirection(const Figure& figure, int limb, const Vec3& upper) {
  const Mat3& trunk = figure.trunkOf(limb);
  const Vec3 down = -trunk.col(1);
  const Vec3 displacement = isLeg(limb) ? Vec3(-trunk.col(2)) : Vec3(trunk.col(2));
  return shortestRotation(down, upper) * displacement;
}

Vec3 toesForward(const Figure& figure, int limb) {
  const FigureLimb& bones = figure.limbs[limb];
  const bool bent = squareTo(bones.upper, bones.lower).norm() > 0.3;
  return squareTo(bones.lower, bent ? bones.upper : Vec3(-bendDirection(figure, limb, bones.upper)));
}

bool upperAllowed(const Mat3& trunk, int limb, const Vec3& upper) {
  const Vec3 local = trunk.transpose() * upper;
  const double out = sideOf(limb) * local.x();
  return isLeg(limb) ? legAllowed(out, local.y(), local.z()) : armAllowed(out, local.y(), local.z());
}

bool limbAllowed(const Figure& figure, int limb) {
  return upperAllowed(figure.trunkOf(limb), limb, figure.limbs[limb].upper) && bendAllowed(figure, limb) &&
         (!isLeg(limb) || footAllowed(figure, limb));
}

}  // namespace limber
