// How the pelvis follows the legs, so that they stand much as their joint angles have them.
#pragma once

#include <optional>
#include <span>

#include "limber/motion/limbs/body/root_motion.h"
#include "limber/motion/limbs/body/trunk_tilt.h"
#include "limber/motion/limbs/limb.h"

namespace limber {

class Pelvis {
 public:
  // Both must outlive this.
  Pelvis(const RetargetSetup& setup, const RootPositioner& root);

  // The line between people's hips leans out of the level, and turns against the trunk, the less the wider they are for
  // their height than the source's: hips as wide as a leg is long would else be swept much further than the source's,
  // and the feet with them. What hangs on the pelvis keeps how it is turned. Someone who lies on one side goes on doing
  // so. `frame` are the globals of `target` by joint angles alone; both are brought up to date.
  void levelHips(Pose& target, BodyFrame& frame) const;

  // A rotation about the hips (RootPositioner::turnPelvis) and then a displacement up, metres.
  struct Move {
    Quat turn = Quat::Identity();
    double up = 0;
  };
  // By the legs' goals, for legs that are where `frame` has them. `rise`: if given, replaces riseFor(). Where a trunk
  // tilts, hips and shoulders each follow their own legs.
  Move moveFor(std::span<const Leg> legs, const BodyFrame& frame, std::optional<double> rise = std::nullopt) const;
  // The turn of it, which brings planted legs nearer to their joint angles.
  Quat turnFor(std::span<const Leg> legs, const BodyFrame& frame) const;
  // How far it goes up, once it is turned, so that planted legs keep the bend that their joint angles give them, on
  // average: metres.
  double riseFor(std::span<const Leg> legs, const BodyFrame& frame, const Quat& turn) const;
  // Whether the leg's goal is where the turned pelvis takes its end, 0, or elsewhere, towards 1: a leg that is left
  // alone may be as straight as it is.
  double changeOf(const Leg& leg, const BodyFrame& frame, const Quat& turn = Quat::Identity()) const;
  // Of a leg's hip by that move, in the person's space.
  Vec3 hipDisplacement(const Move& move, const LegSpec& leg, const BodyFrame& frame) const;
  void apply(const Move& move, Pose& target, BodyFrame& frame) const;
  const TrunkTilt& trunk() const { return tilt_; }

 private:
  Move moveOfEnds(std::span<const Leg> hind, std::span<const Leg> fore, const BodyFrame& frame) const;
  // `rise`, and down as far as the leg that needs it most requires.
  double shiftFor(std::span<const Leg> legs, const BodyFrame& frame, const Quat& turn, double rise) const;
  double raiseFor(std::span<const Leg> legs, const BodyFrame& frame, double shift) const;
  static double steepness(const BodySupport& support, double across, double reach);
  double footDrivenOffset(std::span<const Leg> legs, const BodyFrame& frame) const;

  const RetargetSetup& setup_;
  const RootPositioner& root_;
  TrunkTilt tilt_;
  double hipTurns_ = 1;  // fraction of the source's rotations that wide hips take over
  Index leftHip_ = 0, rightHip_ = 0;
  std::optional<Index> trunk_;  // its last joint
};

}  // namespace limber
