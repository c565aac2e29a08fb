// Keeps one foot where it is planted, and lets it come and go smoothly.
#pragma once

#include <optional>

#include "limber/motion/limbs/contacts/contact_track.h"
#include "limber/motion/limbs/spring.h"

namespace limber {

class FootLock {
 public:
  // Free positions of ankle and toes in this frame, what holds the foot, and the heights that both have when standing.
  struct Frame {
    Vec3 ankle = Vec3::Zero(), toes = Vec3::Zero();
    FootAnchor anchor = FootAnchor::kNone;
    double ankleGround = 0, toesGround = 0;
    bool flat = false;  // both heel and toes rest on the ground
    double slip = 0;    // fraction of its free displacement that it takes while it is pinned
  };

  // Where the ankle goes. Along the ground the foot moves by its free displacement times a fraction that goes to 0
  // while it is pinned, except for its slip, and back to 1; the displacement that pinning prevented is made up for by a
  // critically damped spring once the foot is free. Its height springs to the ground and back. So nothing jumps, and a
  // foot never lands slower than it does without the lock. A foot that lags by more than `slack` is freed until it has
  // caught up. A foot that rests flat does not turn about the vertical either.
  Vec3 next(const Frame& frame, double seconds, double slack);
  // How far it is turned about +Y against the free foot, radians.
  double twist() const { return twist_; }
  // Forgets what was, as before the first frame: the motion jumped.
  void reset() { before_.reset(); }

 private:
  void begin(const Frame& frame);
  void turn(const Frame& frame, double seconds);
  void moveAlong(const Frame& frame, double seconds, double slack);
  void moveUpright(const Frame& frame, double seconds);

  FootAnchor anchor_ = FootAnchor::kNone;
  bool byToes_ = false;  // whether the toes are, or last were, the pinned point
  Vec3 out_ = Vec3::Zero();
  SprungNumber freedom_{1, 0};  // 0 to 1; to which the foot is free
  bool lost_ = false;
  Vec3 catchUpSpeed_ = Vec3::Zero(), rollSpeed_ = Vec3::Zero();
  double lift_ = 0, liftSpeed_ = 0;  // over where the anchor has the ankle, fades out
  SprungNumber turning_{1, 0};       // likewise, to turn about the vertical
  bool twisted_ = false;
  double twist_ = 0;
  Vec3 roll_ = Vec3::Zero(), rolled_ = Vec3::Zero();  // from the ankle to the toes, and its level change in this frame
  std::optional<Frame> before_;
};

}  // namespace limber
