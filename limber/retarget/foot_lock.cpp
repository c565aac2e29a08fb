#include "limber/retarget/foot_lock.h"

#include <cmath>

#include "limber/retarget/spring.h"

namespace limber {

namespace {
// 1/seconds. Along the ground a foot has to stand at once, down to it there is time.
constexpr double kHolding = 80, kReleasing = 40;  // of the share to which it is free
constexpr double kSettling = 20, kLeaving = 16;   // of what fades out
constexpr double kRolling = 40;                   // of the speed left where the point that is held changes
constexpr double kCaughtUp = 0.25;                // of the slack

Vec3 rollOf(const FootLock::Frame& frame, bool byToes) {
  return byToes ? Vec3(frame.toes - frame.ankle) : Vec3(Vec3::Zero());
}

// Height of the ankle over which the foot settles.
double baseHeight(const FootLock::Frame& frame, FootAnchor anchor) {
  if (anchor == FootAnchor::kAnkle) return frame.ankleGround;
  if (anchor == FootAnchor::kToes) return frame.toesGround - (frame.toes - frame.ankle).y();
  return frame.ankle.y();
}

Vec3 level(const Vec3& v) {
  return {v.x(), 0, v.z()};
}

}  // namespace

// The first frame is where the foot is, but on the ground at once.
void FootLock::begin(const Frame& frame) {
  anchor_ = frame.anchor;
  byToes_ = anchor_ == FootAnchor::kToes;
  lost_ = false;
  out_ = frame.ankle;
  out_.y() = baseHeight(frame, anchor_);
  freedom_ = anchor_ == FootAnchor::kNone ? 1 : 0;
  freedomSpeed_ = lift_ = liftSpeed_ = 0;
  catchUpSpeed_ = rollSpeed_ = Vec3::Zero();
  before_ = frame;
}

Vec3 FootLock::next(const Frame& frame, double seconds, double slack) {
  if (!before_ || seconds <= 0) {
    begin(frame);
    return out_;
  }
  moveAlong(frame, seconds, slack);
  moveUpright(frame, seconds);
  before_ = frame;
  return out_;
}

void FootLock::moveAlong(const Frame& frame, double seconds, double slack) {
  const Vec3 behind = level(before_->ankle - out_);
  lost_ = frame.anchor != FootAnchor::kNone && behind.norm() > (lost_ ? kCaughtUp : 1) * slack;
  const bool held = frame.anchor != FootAnchor::kNone && !lost_;
  springTo(held ? 0.0 : 1.0, held ? kHolding : kReleasing, seconds, freedom_, freedomSpeed_);

  Vec3 left = -behind;
  springTo(Vec3(Vec3::Zero()), kLeaving, seconds, left, catchUpSpeed_);
  catchUpSpeed_ *= freedom_;
  const Vec3 freeWay = level(frame.ankle - before_->ankle) + left + behind;
  const auto rolled = [&](bool byToes) { return level(rollOf(frame, byToes) - rollOf(*before_, byToes)); };
  const bool byToes = frame.anchor == FootAnchor::kNone ? byToes_ : frame.anchor == FootAnchor::kToes;
  // Where another point is held from here on, the ankle's speed goes over to that which this point leaves it.
  rollSpeed_ += (1 - freedom_) * (rolled(byToes) - rolled(byToes_)) / seconds;
  byToes_ = byToes;
  rollSpeed_ *= std::exp(-kRolling * seconds);
  // The point moves by `freedom_` of its free way, and the ankle as the foot turns about it.
  out_ += freedom_ * freeWay - (1 - freedom_) * rolled(byToes_) + seconds * rollSpeed_;
}

void FootLock::moveUpright(const Frame& frame, double seconds) {
  const double base = baseHeight(frame, anchor_);
  const double speed = (base - baseHeight(*before_, anchor_)) / seconds;
  springTo(0.0, anchor_ == FootAnchor::kNone ? kLeaving : kSettling, seconds, lift_, liftSpeed_);
  out_.y() = base + lift_;
  if (frame.anchor == anchor_) return;
  anchor_ = frame.anchor;
  const double newBase = baseHeight(frame, anchor_);
  lift_ = out_.y() - newBase;
  liftSpeed_ += speed - (newBase - baseHeight(*before_, anchor_)) / seconds;
}

}  // namespace limber
