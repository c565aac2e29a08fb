// Brings the end of one limb to its goal, the others stay: shared by the methods that solve limb by limb.
#pragma once

#include "limber/motion/limbs/limb_goals.h"
#include "limber/skeleton/ik/solvers/two_bone.h"

namespace limber {

// What a limb is bent by to reach its goal.
struct LimbShape {
  Vec3 middle, end, hock;          // the displacements to these from the upper joint
  bool hockCarriesMiddle = false;  // else the middle carries the hock
  Vec3 ahead;                      // LimbSpec::kneeAhead as the upper joint is turned
  // LimbSpec::ownBend: the direction to the end and kneeAhead, both of the neutral pose, as the body is turned.
  Vec3 neutralEnd = Vec3::UnitY(), neutralAhead = Vec3::UnitZ();
  Vec3 line, bend;  // of what is above: a unit vector to the end, and how the middle is to lie off that line

  void findBend(const LimbSpec& limb);
};

class LimbReach {
 public:
  // Both must outlive this.
  LimbReach(const RetargetSetup& setup, const RootPositioner& root) : setup_(setup), root_(root) {}

  // Two bones in closed form. `frame` are the globals of `target`; both are brought up to date. The end keeps its
  // orientation, but for the goal's turn. With LimbSpec::kneeAhead the middle joint bends to where it bends now, and to
  // that side where it hardly bends or is a little overstretched: else it would snap from one side to the other. A limb
  // with LimbSpec::ownBend always bends to that side. A hock takes its part of the change first.
  void reach(const LimbSpec& limb, const LimbGoal& goal, BodyFrame& frame, Pose& target) const;
  // Whether the end is at its goal already, and turned as it has to be.
  static bool isThere(const LimbSpec& limb, const LimbGoal& goal, const BodyFrame& frame);
  // Turns a joint at the end of a limb to `orientation`. `frame` as above.
  void turnEnd(Index end, const Quat& orientation, BodyFrame& frame, Pose& target) const;

  LimbShape shapeOf(const LimbSpec& limb, const BodyFrame& frame) const;
  // The displacements from the upper joint to where reach() brings the middle and the end, for a goal at `there` from
  // it.
  static TwoBonePositions positionsFor(const LimbSpec& limb, LimbShape shape, const Vec3& there);

 private:
  Quat turnOf(Index joint, const BodyFrame& frame) const;  // against the neutral pose

  const RetargetSetup& setup_;
  const RootPositioner& root_;
};

}  // namespace limber
