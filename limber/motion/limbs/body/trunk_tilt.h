// How steeply the trunk of a quadruped goes up.
#pragma once

#include <vector>

#include "limber/motion/limbs/body/root_motion.h"

namespace limber {

// Of quadrupeds that were matched by their form. Trunks differ in length more than legs do: one that is longer and
// turns as the source's takes the shoulders further, and forefeet off the ground. It turns about the hips; legs, neck
// and tail on it keep how they are turned (RootPositioner::turnPelvis).
class TrunkTilt {
 public:
  // Both must outlive this.
  TrunkTilt(const RetargetSetup& setup, const RootPositioner& root);

  // False for people, and where legs or trunk are told otherwise.
  bool tilts() const { return !shoulders_.empty(); }

  // The shoulders rise over the hips by as much as the source's do, scaled. `frame` are the globals of `target` by
  // joint angles alone; both are brought up to date.
  void follow(const BodyFrame& source, Pose& target, BodyFrame& frame) const;
  // From the hips to the shoulders.
  Vec3 trunkOf(const BodyFrame& frame) const;
  // The turn by which they rise by that, metres, as far as the trunk is long.
  static Quat turnFor(double rise, const Vec3& trunk);
  // Their displacement for each metre of that rise, to first order; straight up where the trunk is upright.
  static Vec3 liftOf(const Vec3& trunk);

 private:
  const RetargetSetup& setup_;
  const RootPositioner& root_;
  std::vector<Index> hips_, shoulders_, sourceHips_, sourceShoulders_;  // where legs begin
};

}  // namespace limber
