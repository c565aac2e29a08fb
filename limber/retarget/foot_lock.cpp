#include "limber/retarget/foot_lock.h"

#include "limber/retarget/spring.h"

namespace limber {

namespace {
// 1/seconds: how fast what is left fades out; along the ground a foot has to stand at once, down to it there is time.
constexpr double kLanding = 40, kSettling = 20, kLeaving = 16;
}  // namespace

Vec3 FootLock::base(const Frame& frame) const {
  if (anchor_ == FootAnchor::kAnkle) return lock_;
  if (anchor_ == FootAnchor::kToes) return lock_ - (frame.toes - frame.ankle);
  return frame.ankle;
}

// The first frame is where the foot is, but on the ground at once.
void FootLock::begin(const Frame& frame) {
  anchor_ = frame.anchor;
  lock_ = anchor_ == FootAnchor::kToes ? frame.toes : frame.ankle;
  lock_.y() = anchor_ == FootAnchor::kToes ? frame.toesGround : frame.ankleGround;
  rest_ = restSpeed_ = Vec3::Zero();
  before_ = frame;
}

Vec3 FootLock::next(const Frame& frame, double seconds, double slack) {
  if (!before_ || seconds <= 0) {
    begin(frame);
    return base(frame);
  }
  // As if the anchor stayed: the base moves, and what is left fades out.
  const Vec3 baseSpeed = (base(frame) - base(*before_)) / seconds;
  for (int axis = 0; axis < 3; ++axis) {
    const double rate = anchor_ == FootAnchor::kNone ? kLeaving : axis == 1 ? kSettling : kLanding;
    springTo(0.0, rate, seconds, rest_[axis], restSpeed_[axis]);
  }

  const bool lost = anchor_ != FootAnchor::kNone && (base(frame) - frame.ankle).norm() > slack;
  if (frame.anchor != anchor_ || lost) change(frame, base(frame) + rest_, baseSpeed + restSpeed_, seconds, lost);
  before_ = frame;
  return base(frame) + rest_;
}

// The foot is at `out` and moves at `speed`; from there to where the new anchor has it.
void FootLock::change(const Frame& frame, const Vec3& out, const Vec3& speed, double seconds, bool lost) {
  anchor_ = frame.anchor;
  const bool toes = anchor_ == FootAnchor::kToes;
  const Vec3 roll = toes ? Vec3(frame.toes - frame.ankle) : Vec3(Vec3::Zero());
  if (anchor_ != FootAnchor::kNone) {
    const Vec3 rollBefore = toes ? Vec3(before_->toes - before_->ankle) : Vec3(Vec3::Zero());
    const Vec3 pointSpeed = speed + (roll - rollBefore) / seconds;
    // It comes to rest ahead, where its speed carries it while the spring takes that away.
    lock_ = (lost ? frame.ankle : Vec3(out + pointSpeed / kLanding)) + roll;
    lock_.y() = toes ? frame.toesGround : frame.ankleGround;
  }
  rest_ = out - base(frame);
  restSpeed_ = speed - (base(frame) - base(*before_)) / seconds;
}

}  // namespace limber
