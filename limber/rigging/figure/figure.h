// A person in any pose, as few numbers as tell it: a head, a trunk of two parts and four limbs of two bones.
#pragma once

#include <array>

#include "limber/core/types.h"

namespace limber {

inline constexpr int kFigureLimbs = 4;  // left arm, right arm, left leg, right leg
inline bool isLeg(int limb) {
  return limb >= 2;
}
inline double sideOf(int limb) {
  return limb % 2 == 0 ? 1 : -1;
}

// Parts of a grown body, in statures: lengths of bones and half widths. After Drillis and Contini's table of segments
// (in Winter, Biomechanics and Motor Control of Human Movement, 2009); widths after the same body's breadths.
namespace proportions {
inline constexpr double kHeadRadius = 0.061, kNeckLength = 0.045, kNeckRadius = 0.032;
inline constexpr double kThorax = 0.165, kLoins = 0.15;  // from the neck's base to the waist, on to the hips
inline constexpr double kShoulderDrop = 0.015, kShoulderHalf = 0.1, kHipHalf = 0.05;
inline constexpr double kUpperArm = 0.172, kForearm = 0.145, kHand = 0.09;
inline constexpr double kThigh = 0.245, kShank = 0.245, kFoot = 0.12;
}  // namespace proportions

// All directions are unit vectors.
struct FigureLimb {
  Vec3 upper = -Vec3::UnitY(), lower = -Vec3::UnitY();  // of the upper arm or thigh, the forearm or shank
  Vec3 end = -Vec3::UnitY();                            // of the hand or foot
  Vec3 shift = Vec3::Zero();              // of the shoulder from its rest position, in statures along the chest's axes
  double upperScale = 1, lowerScale = 1;  // lengths against the proportions'
};

struct LimbPositions {
  Vec3 root, middle, ankle, tip;  // shoulder or hip, elbow or knee, wrist or ankle, the end of hand or foot
};

// Whether elbows or knees are nearer than `middle` to each other and wrists or ankles than `ankle`.
inline bool alike(const LimbPositions& a, const LimbPositions& b, double middle, double ankle) {
  return (a.middle - b.middle).norm() < middle && (a.ankle - b.ankle).norm() < ankle;
}

struct Figure {
  double stature = 1;                                        // as it would stand upright
  Vec3 head = Vec3::Zero();                                  // the middle of the ball
  double headRadius = proportions::kHeadRadius;              // in the unit of positions, not of the stature
  Vec3 neck = -Vec3::UnitY();                                // direction from the head to the neck's base
  double neckLength = proportions::kNeckLength;              // statures
  Mat3 chest = Mat3::Identity(), pelvis = Mat3::Identity();  // columns: left, up, front of the body
  std::array<FigureLimb, kFigureLimbs> limbs;

  Vec3 neckBase() const { return head + (1.05 * headRadius + neckLength * stature) * neck; }
  Vec3 waist() const { return neckBase() - proportions::kThorax * stature * chest.col(1); }
  Vec3 hips() const { return waist() - proportions::kLoins * stature * pelvis.col(1); }
  // Where a skeleton has its joints: the neck's, that of the head on it, the middle of the hips.
  Vec3 neckJoint() const { return neckBase() - 0.02 * stature * chest.col(1); }
  Vec3 skullBase() const { return neckBase() + 0.35 * (head - neckBase()); }
  Vec3 pelvisJoint() const { return hips() + 0.01 * stature * pelvis.col(1); }
  const Mat3& trunkOf(int limb) const { return isLeg(limb) ? pelvis : chest; }
  // The shoulder (where it would be without its shift) or the hip.
  Vec3 socket(int limb) const;
  LimbPositions positions(int limb) const;
};

// Lengths of the upper and of the lower bone, in statures.
double upperLength(int limb);
double lowerLength(int limb);

// The direction in which an elbow or knee bends that is rotated neither in nor out: square to `upper`.
Vec3 bendDirection(const Figure& figure, int limb, const Vec3& upper);

// Where the toes of a leg point: square to the shank, with the knee; of any length.
Vec3 toesForward(const Figure& figure, int limb);

// Whether people can hold a limb so, roughly: where the upper bone points, how and how far elbow or knee bend, and
// whether toes point where the knee does.
bool upperAllowed(const Mat3& trunk, int limb, const Vec3& upper);
bool limbAllowed(const Figure& figure, int limb);

}  // namespace limber
