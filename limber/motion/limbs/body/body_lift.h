// Keeps the trunk of an animal that sits or lies out of the ground.
#pragma once

#include <vector>

#include "limber/motion/limbs/body/root_motion.h"

namespace limber {

// How far an animal has to rise for its body to come no further down than the source's, scaled: bodies differ in width
// and depth, and hips that follow the source's path take them below the ground. Looks at the trunk and where legs
// begin: heads, tails and feet may come down on their own.
class BodyLift {
 public:
  // Nothing to lift for people. `setup` must outlive this.
  explicit BodyLift(const RetargetSetup& setup);

  // `frame` are the globals of `target`; both are brought up to date.
  void apply(const BodyFrame& source, const RootPositioner& root, Pose& target, BodyFrame& frame) const;
  // Metres, at least 0, without a jump from frame to frame.
  double operator()(const BodyFrame& source, const BodyFrame& target) const;

 private:
  struct Pair {
    Index source = 0, target = 0;
  };

  const RetargetSetup& setup_;
  std::vector<Pair> body_;
};

}  // namespace limber
