#include "limber/rigging/figure/limb_overlap.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

constexpr double kArmThick[] = {0.028, 0.022}, kLegThick[] = {0.045, 0.03};  // statures, upper and lower
constexpr double kRoot = 0.4;  // of the upper bone that counts for nothing
constexpr double kAlong[] = {0.55, 0.8, 1}, kAlongLower[] = {0.25, 0.5, 0.75, 1};
constexpr double kTouch = 0.15, kDeep = 0.6;  // of both thicknesses: depth of a touch, and from there to full overlap

// How far a position on a limb lies in another limb, 0 to 1: by the bone that it is deepest in.
double within(const LimbSpace::Sample& sample, const LimbSpace& other) {
  double least = 0, width = 1;
  for (const LimbSpace::Bone& bone : other.bones) {
    const double thick = sample.thick + bone.thick;
    const Vec3 from = sample.at - bone.from;
    const double along = std::clamp(from.dot(bone.direction) * bone.perLength2, 0.0, 1.0);
    const double apart2 = (from - along * bone.direction).squaredNorm();
    if (apart2 >= thick * thick) continue;
    const double gap = std::sqrt(apart2) - thick;
    if (gap >= least) continue;
    least = gap;
    width = thick;
  }
  return std::clamp((-least / width - kTouch) / kDeep, 0.0, 1.0);
}

double overlapOneSided(const LimbSpace& limb, const LimbSpace& other) {
  double shared = 0;
  for (const LimbSpace::Sample& sample : limb.samples) shared += within(sample, other);
  return shared;
}

}  // namespace

LimbSpace spaceOf(const Figure& figure, int limb) {
  const LimbPositions joints = figure.positions(limb);
  const double* thick = isLeg(limb) ? kLegThick : kArmThick;
  const double upper = thick[0] * figure.stature, lower = thick[1] * figure.stature;
  LimbSpace space;
  std::size_t next = 0;
  for (const double at : kAlong) space.samples[next++] = {joints.root + at * (joints.middle - joints.root), upper};
  for (const double at : kAlongLower) {
    space.samples[next++] = {joints.middle + at * (joints.ankle - joints.middle), lower};
  }
  space.samples[next] = {joints.tip, lower};
  const auto bone = [](const Vec3& from, const Vec3& to, double radius) {
    const Vec3 displacement = to - from;
    return LimbSpace::Bone{from, displacement, 1 / displacement.squaredNorm(), radius};
  };
  const Vec3 start = joints.root + kRoot * (joints.middle - joints.root);
  space.bones = {bone(start, joints.middle, upper), bone(joints.middle, joints.ankle, lower),
                 bone(joints.ankle, joints.tip, lower)};
  space.middle = joints.middle;
  for (const Vec3& end : {start, joints.ankle, joints.tip}) {
    space.reach = std::max(space.reach, (end - space.middle).norm());
  }
  space.reach += upper;
  return space;
}

double limbOverlap(const LimbSpace& a, const LimbSpace& b) {
  const double reach = a.reach + b.reach;
  if ((a.middle - b.middle).squaredNorm() >= reach * reach) return 0;
  return overlapOneSided(a, b) + overlapOneSided(b, a);
}

}  // namespace limber
