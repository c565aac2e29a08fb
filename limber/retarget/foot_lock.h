// Keeps one foot where it is planted, and lets it come and go smoothly.
#pragma once

#include <optional>

#include "limber/core/types.h"

namespace limber {

// What holds the foot: nothing, its ankle, or its toes (about which it rolls).
enum class FootAnchor { kNone, kAnkle, kToes };

class FootLock {
 public:
  // Free positions of ankle and toes in this frame, what holds the foot, and the heights that both have when standing.
  struct Frame {
    Vec3 ankle = Vec3::Zero(), toes = Vec3::Zero();
    FootAnchor anchor = FootAnchor::kNone;
    double ankleGround = 0, toesGround = 0;
  };

  // Where the ankle goes. A change of the anchor never jumps: what it would is faded out with the speed that the foot
  // has, in about a tenth of a second (a critically damped spring). A lock that the free foot leaves behind by more
  // than `slack` is given up and taken anew.
  Vec3 next(const Frame& frame, double seconds, double slack);
  // Forgets what was, as before the first frame: the motion jumped.
  void reset() { before_.reset(); }

 private:
  void begin(const Frame& frame);
  void change(const Frame& frame, const Vec3& out, const Vec3& speed, double seconds, bool lost);
  Vec3 base(const Frame& frame) const;

  FootAnchor anchor_ = FootAnchor::kNone;
  Vec3 lock_ = Vec3::Zero();                             // of the anchor
  Vec3 rest_ = Vec3::Zero(), restSpeed_ = Vec3::Zero();  // what fades out
  std::optional<Frame> before_;
};

}  // namespace limber
