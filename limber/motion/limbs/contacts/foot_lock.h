// Keeps one foot where it is planted, and lets it come and go smoothly.
#pragma once

#include <optional>

#include "limber/motion/limbs/contacts/contact_track.h"

namespace limber {

class FootLock {
 public:
  // Free positions of ankle and toes in this frame, what holds the foot, and the heights that both have when standing.
  struct Frame {
    Vec3 ankle = Vec3::Zero(), toes = Vec3::Zero();
    FootAnchor anchor = FootAnchor::kNone;
    double ankleGround = 0, toesGround = 0;
    bool flat = false;  // heel and toes stand both
    double slip = 0;    // share of its free way that it takes while it is held
  };

  // Where the ankle goes. Along the ground the foot moves as it would be free to, times a share that goes to 0 while it
  // is held, but for what it may slip, and back to 1; the way that it was held back is made up for by a critically
  // damped spring once it is free. Its height springs to the ground and back. So nothing jumps, and a foot never lands
  // slower than it does unheld. One that is held back by more than `slack` goes free until it has caught up. A foot
  // that stands flat does not turn about the vertical either.
  Vec3 next(const Frame& frame, double seconds, double slack);
  // How far it is turned about +Y against the free foot, radians.
  double twist() const { return twist_; }
  // Forgets what was, as before the first frame: the motion jumped.
  void reset() { before_.reset(); }

 private:
  // To which the foot is free, 0 to 1.
  struct Factor {
    double value = 1, speed = 0;
    void follow(double wanted, double seconds);
  };
  void begin(const Frame& frame);
  void turn(const Frame& frame, double seconds);
  void moveAlong(const Frame& frame, double seconds, double slack);
  void moveUpright(const Frame& frame, double seconds);

  FootAnchor anchor_ = FootAnchor::kNone;
  bool byToes_ = false;  // the point that is held, or was at last
  Vec3 out_ = Vec3::Zero();
  Factor freedom_;
  bool lost_ = false;
  Vec3 catchUpSpeed_ = Vec3::Zero(), rollSpeed_ = Vec3::Zero();
  double lift_ = 0, liftSpeed_ = 0;  // over where the anchor has the ankle, fades out
  Factor turning_;
  bool twisted_ = false;
  double twist_ = 0;
  Vec3 roll_ = Vec3::Zero(), rolled_ = Vec3::Zero();  // from the ankle to the toes, and the level way in this frame
  std::optional<Frame> before_;
};

}  // namespace limber
