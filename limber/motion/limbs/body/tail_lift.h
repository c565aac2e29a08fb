// Keeps an animal's tail out of the ground.
#pragma once

#include <vector>

#include "limber/motion/limbs/body/root_motion.h"

namespace limber {

// Tails differ in length more than legs do: one that hangs as the source's may end below the ground. It turns up about
// its first joint until no joint of it does, to the side to which it points; from afar, without a jump.
class TailLift {
 public:
  // None for people, and where no joint is called a tail. Both must outlive this.
  TailLift(const RetargetSetup& setup, const RootPositioner& root);

  // `frame` are the globals of `target`; both are brought up to date.
  void apply(Pose& target, BodyFrame& frame) const;

 private:
  // How far it has to turn up, radians.
  double needed(const BodyFrame& frame) const;
  Vec3 heading(const BodyFrame& frame) const;

  const RetargetSetup& setup_;
  const RootPositioner& root_;
  std::vector<Index> tail_;  // of the target, root to tip
};

}  // namespace limber
