// Brings the end of one limb to its goal, the others stay: shared by the methods that solve limb by limb.
#pragma once

#include "limber/ik/two_bone.h"
#include "limber/limbs/limb_goals.h"

namespace limber {

class LimbReach {
 public:
  // Both must outlive this.
  LimbReach(const RetargetSetup& setup, const RootPlacer& root) : setup_(setup), root_(root) {}

  // Two bones in closed form. `frame` are the globals of `target`; both are brought up to date. The end keeps how it is
  // turned, but for limb.turn. With `kneeAhead` (Leg) the middle joint bends to where it bends now, and to that side
  // where it hardly bends or is a little overstretched: else it would snap from one side to the other. One with
  // Limb::ownBend always bends to that side. A hock (Limb) takes its share of the way first.
  void reach(const Limb& limb, const Vec3* kneeAhead, BodyFrame& frame, Pose& target) const;
  // Whether the end is at its goal already, and turned as it has to be.
  static bool isThere(const Limb& limb, const BodyFrame& frame);
  // Turns the end to `orientation`. `frame` as above.
  void turnEnd(const Limb& limb, const Quat& orientation, BodyFrame& frame, Pose& target) const;

 private:
  void bendHock(const Limb& limb, BodyFrame& frame, Pose& target) const;
  Vec3 ownBend(const Limb& limb, const Vec3& way, const Vec3& kneeAhead, const BodyFrame& frame) const;
  Quat turnOf(Index joint, const BodyFrame& frame) const;  // against the neutral pose
  Vec3 kneePole(const Limb& limb, const TwoBone& bones, const Vec3& kneeAhead, const BodyFrame& frame) const;

  const RetargetSetup& setup_;
  const RootPlacer& root_;
};

}  // namespace limber
