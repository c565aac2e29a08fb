#include "limber/motion/mix/transition.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/motion/mix/gait/joint_clock.h"

namespace limber {

namespace {

constexpr double kReach = 1;       // seconds; 0.5 to 3; into either motion, about a stride; set by hand
constexpr double kForeseen = 0.1;  // seconds; 0.03 to 0.3; for which joints go on at their speeds; set by hand

// 0 to 1.
double minJerk(double u) {
  return u * u * u * (10 + u * (6 * u - 15));
}

// One motion's frames near the transition.
struct Seen {
  std::vector<Vec3> positions, ahead;  // of the joints, in the body's own frame
  std::vector<bool> planted;           // of the body's legs
};

class SeenFrames {
 public:
  SeenFrames(const MixBody& body, const MixMotion& motion, double from, double to, double frameSeconds)
      : from_(from), step_(frameSeconds) {
    const auto frames = static_cast<std::size_t>(std::floor((to - from) / frameSeconds + kSameTime)) + 1;
    std::vector<std::vector<TimeSpan>> spans;
    for (const LegSpec& leg : body.legs()) spans.push_back(motion.planted(leg.end));
    for (std::size_t f = 0; f < frames; ++f) {
      const double now = from + static_cast<double>(f) * frameSeconds;
      const bool isLast = now + frameSeconds > motion.duration() + kSameTime;
      const double other = isLast ? now - frameSeconds : now + frameSeconds;
      const GroundFrame ground = motion.groundAt(now);
      Seen& seen = frames_.emplace_back();
      seen.positions = seen.ahead = positionsAt(body, motion, now, ground);
      const std::vector<Vec3> moved = positionsAt(body, motion, other, ground);
      const double fraction = (isLast ? -kForeseen : kForeseen) / frameSeconds;
      for (std::size_t j = 0; j < moved.size(); ++j) seen.ahead[j] += fraction * (moved[j] - seen.positions[j]);
      for (const std::vector<TimeSpan>& of : spans) {
        seen.planted.push_back(std::any_of(of.begin(), of.end(), [&](const TimeSpan& span) {
          return span.from <= now + kSameTime && now <= span.to + kSameTime;
        }));
      }
    }
  }

  const Seen& at(double seconds) const {
    const double frame =
        std::clamp(std::round((seconds - from_) / step_), 0.0, static_cast<double>(frames_.size() - 1));
    return frames_[static_cast<std::size_t>(frame)];
  }

 private:
  static std::vector<Vec3> positionsAt(const MixBody& body, const MixMotion& motion, double seconds,
                                       const GroundFrame& ground) {
    Pose pose;
    motion.sample(seconds, pose);
    enterFrame(body, ground, pose);
    BodyFrame frame;
    body.globals(pose, frame);
    return frame.positions;
  }

  double from_, step_;
  std::vector<Seen> frames_;
};

double distanceOf(const Seen& a, const Seen& b) {
  double sum = 0;
  for (std::size_t j = 0; j < a.positions.size(); ++j) {
    sum += (a.positions[j] - b.positions[j]).squaredNorm() + (a.ahead[j] - b.ahead[j]).squaredNorm();
  }
  return sum;
}

bool haveCommonFoot(const Seen& a, const Seen& b) {
  for (std::size_t leg = 0; leg < a.planted.size(); ++leg) {
    if (a.planted[leg] && b.planted[leg]) return true;
  }
  return false;
}

class TransitionSearch {
 public:
  TransitionSearch(const MixBody& body, const MixMotion& a, const MixMotion& b, const TransitionOptions& options)
      : a_(a),
        b_(b),
        frameSeconds_(options.frameSeconds),
        frames_(wholeFrames(options.seconds)),
        bReach_(std::min(kReach, (b.duration() - options.seconds) / 2)),
        first_(firstFrame(options)),
        ofA_(body, a, first_ * frameSeconds_, a.duration(), frameSeconds_),
        ofB_(body, b, 0, b.duration(), frameSeconds_) {}

  std::optional<Transition> run() {
    for (const StridePhases& phases : matchStrides(a_.footfalls(), b_.footfalls())) {
      for (double frame = first_; frame * frameSeconds_ <= a_.duration(); ++frame) consider(phases, frame);
    }
    if (!best_) considerAnyTwo();
    return std::move(best_);
  }

 private:
  std::size_t wholeFrames(double seconds) const {
    return static_cast<std::size_t>(std::max(1.0, std::floor(seconds / frameSeconds_ + kSameTime)));
  }

  double firstFrame(const TransitionOptions& options) const {
    const double reach = std::min(kReach, (a_.duration() - options.from - options.seconds) / 2);
    const double lasts = static_cast<double>(frames_) * frameSeconds_;
    const double first = std::floor((a_.duration() - lasts - reach) / frameSeconds_ + kSameTime);
    if (options.from <= 0) return std::max(first, 0.0);
    const double latest = std::floor((a_.duration() - lasts) / frameSeconds_ + kSameTime);
    return std::max(first, std::min(latest, std::floor(options.from / frameSeconds_ + kSameTime) + 1));
  }

  // Each at its own speed: a phase is a second.
  void considerAnyTwo() {
    for (double frame = first_; frame * frameSeconds_ <= a_.duration(); ++frame) {
      for (double other = 0; other * frameSeconds_ <= bReach_; ++other) {
        consider({GaitPhase({0, 1}, 0), GaitPhase({0, 1}, (frame - other) * frameSeconds_), 0, 1}, frame);
      }
    }
  }

  // The transition from that frame of a, at both motions' speed times `speed`.
  std::vector<MixMoment> played(const StridePhases& phases, double frame, double speed) const {
    const auto weightAt = [&](std::size_t f) { return minJerk(static_cast<double>(f) / static_cast<double>(frames_)); };
    JointClock clock(phases, frame * frameSeconds_);
    std::vector<MixMoment> moments;
    for (std::size_t f = 0; f <= frames_; ++f) {
      moments.push_back({clock.a(), clock.b(), weightAt(f)});
      if (f < frames_) clock.advance(speed * frameSeconds_, weightAt(f), weightAt(f + 1));
    }
    return moments;
  }

  void consider(const StridePhases& phases, double frame) {
    const double begin = phases.b.when(phases.a.at(frame * frameSeconds_));
    if (begin < -kSameTime || begin > bReach_ + kSameTime) return;
    std::vector<MixMoment> moments = played(phases, frame, 1);
    // The rest of b is on its own frames.
    const double end = *moments.back().b, onFrame = std::round(end / b_.frameSeconds()) * b_.frameSeconds();
    moments = played(phases, frame, (onFrame - begin) / std::max(end - begin, kSameTime));
    moments.back().b = onFrame;
    if (*moments.back().a > a_.duration() + kSameTime || onFrame > b_.duration() + kSameTime) return;
    const auto at = [&](std::size_t f) { return std::pair(&ofA_.at(*moments[f].a), &ofB_.at(*moments[f].b)); };
    double distance = 0;
    for (const std::size_t f : {std::size_t{0}, frames_ / 2, frames_}) {
      const auto [a, b] = at(f);
      distance += distanceOf(*a, *b);
    }
    const auto [a, b] = at(frames_ / 2);
    const bool commonFoot = haveCommonFoot(*a, *b);
    if (best_ && (commonFoot != bestHasFoot_ ? bestHasFoot_ : distance >= distance_)) return;
    best_ = Transition{phases, std::move(moments)};
    bestHasFoot_ = commonFoot;
    distance_ = distance;
  }

  const MixMotion &a_, &b_;
  double frameSeconds_;
  std::size_t frames_;
  double bReach_, first_;
  SeenFrames ofA_, ofB_;
  std::optional<Transition> best_;
  bool bestHasFoot_ = false;
  double distance_ = 0;
};

}  // namespace

Transition findTransition(const MixBody& body, const MixMotion& a, const MixMotion& b,
                          const TransitionOptions& options) {
  const double step = options.frameSeconds, shortest = std::min(a.duration() - options.from, b.duration());
  const auto refusal = [&](std::string message, std::string hint) {
    return Error(ErrorCode::kBadArgument, std::move(message), fmt::format("{}, {}", a.name(), b.name()),
                 std::move(hint));
  };
  if (!(options.seconds >= step)) {
    throw refusal(fmt::format("a transition of {:.3g} s is shorter than a frame", options.seconds),
                  fmt::format("choose one of {:.3g} s or more", step));
  }
  // What fits but for the frames of either may not fit with them.
  TransitionOptions shorter = options;
  shorter.seconds = std::min(options.seconds, shortest);
  for (; shorter.seconds > step - kSameTime; shorter.seconds -= step) {
    if (std::optional<Transition> found = TransitionSearch(body, a, b, shorter).run()) return std::move(*found);
  }
  throw refusal(fmt::format("a motion of {:.3g} s is too short for a transition", shortest), "leave it out");
}

}  // namespace limber
