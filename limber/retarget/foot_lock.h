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

  // Where the ankle goes. Along the ground the foot moves as it would be free to, times a share that goes to 0 while it
  // is held and back to 1; the way that it was held back is made up for by a critically damped spring once it is free.
  // Its height springs to the ground and back. So nothing jumps, and a foot never lands slower than it does unheld. One
  // that is held back by more than `slack` goes free until it has caught up.
  Vec3 next(const Frame& frame, double seconds, double slack);
  // Forgets what was, as before the first frame: the motion jumped.
  void reset() { before_.reset(); }

 private:
  void begin(const Frame& frame);
  void moveAlong(const Frame& frame, double seconds, double slack);
  void moveUpright(const Frame& frame, double seconds);

  FootAnchor anchor_ = FootAnchor::kNone;
  bool byToes_ = false;  // the point that is held, or was at last
  bool lost_ = false;
  Vec3 out_ = Vec3::Zero();
  double freedom_ = 1, freedomSpeed_ = 0;
  Vec3 catchUpSpeed_ = Vec3::Zero(), rollSpeed_ = Vec3::Zero();
  double lift_ = 0, liftSpeed_ = 0;  // over where the anchor has the ankle, fades out
  std::optional<Frame> before_;
};

}  // namespace limber
