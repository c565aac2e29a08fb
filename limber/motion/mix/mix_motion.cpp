#include "limber/motion/mix/mix_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/text/numbers.h"
#include "limber/motion/limbs/roughness.h"
#include "limber/motion/mix/pose_curve.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

// Hip heights; 0.01 to 0.06; root mean square over the joints, between a loop's first and last frame; set by hand.
constexpr double kLoopError = 0.03;

// Joints in the body's own frame.
std::vector<Vec3> positionsInBody(const MixBody& body, const MixMotion& motion, double seconds) {
  Pose pose;
  motion.sample(seconds, pose);
  enterFrame(body, motion.groundAt(seconds), pose);
  BodyFrame frame;
  body.globals(pose, frame);
  return frame.positions;
}

double squaredDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]).squaredNorm();
  return sum / static_cast<double>(a.size());
}

// From a footfall to the next one of the same foot, on average; 0 where no foot comes down twice.
double strideSeconds(const std::vector<Footfall>& falls) {
  double seconds = 0, strides = 0;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const auto next = std::find_if(falls.begin() + static_cast<std::ptrdiff_t>(i) + 1, falls.end(),
                                   [&](const Footfall& fall) { return fall.foot == falls[i].foot; });
    if (next == falls.end()) continue;
    seconds += next->seconds - falls[i].seconds;
    ++strides;
  }
  return strides > 0 ? seconds / strides : 0;
}

// From each heading to the mean over the stride around it; at the ends over the first and the last stride, straight on.
std::vector<double> swaysOf(const std::vector<double>& headings, double stride) {
  std::vector<double> sways(headings.size(), 0.0);
  const auto half = static_cast<std::size_t>(std::round(stride / 2));
  if (half == 0 || 2 * half >= headings.size()) return sways;
  const double window = 2 * static_cast<double>(half);
  for (std::size_t f = 0; f < headings.size(); ++f) {
    const std::size_t middle = std::clamp(f, half, headings.size() - 1 - half);
    const double first = headings[middle - half], last = headings[middle + half];
    double sum = -(first + last) / 2;
    for (std::size_t k = middle - half; k <= middle + half; ++k) sum += headings[k];
    const double further = static_cast<double>(f) - static_cast<double>(middle);
    sways[f] = sum / window + (last - first) / window * further - headings[f];
  }
  return sways;
}

double swayAt(const std::vector<double>& sways, double frame) {
  const CurveWeights curve = curveWeights(std::clamp(frame, 0.0, static_cast<double>(sways.size() - 1)), sways.size());
  double sway = 0;
  for (std::size_t i = 0; i < 4; ++i) sway += curve.weights[i] * sways[curve.frames[i]];
  return sway;
}

}  // namespace

MixMotion::MixMotion(const MixBody& body, const ClipWithContacts& motion, bool keepAll)
    : body_(&body), name_(motion.clip.name), feet_(motion.feet) {
  checkClip(motion.clip, body.original());
  frames_ = body.plain().plain(sampleFrames(body.original(), motion.clip, denseFrameRateOf(motion.clip)));
  if (feet_.empty()) feet_ = plantedFeet(body.setup(), frames_);
  feet_ = steadied(std::move(feet_));
  if (!keepAll) leaveOutFirstPose();
  readSteps();
}

void MixMotion::leaveOutFirstPose() {
  if (frames_.poses.size() < 3) return;
  BodyFrame first, second;
  body_->globals(frames_.poses[0], first);
  body_->globals(frames_.poses[1], second);
  if (!isCut(body_->setup(), first.positions, second.positions, frames_.frameSeconds)) return;
  frames_.poses.erase(frames_.poses.begin());
  for (FootSpans& foot : feet_) {
    std::erase_if(foot.planted, [&](const TimeSpan& span) { return span.to < frames_.frameSeconds; });
    for (TimeSpan& span : foot.planted) {
      span = {std::max(0.0, span.from - frames_.frameSeconds), span.to - frames_.frameSeconds};
    }
  }
}

std::vector<TimeSpan> MixMotion::planted(Index foot) const {
  const auto found = std::find_if(feet_.begin(), feet_.end(), [&](const FootSpans& of) { return of.foot == foot; });
  return found == feet_.end() ? std::vector<TimeSpan>() : found->planted;
}

void MixMotion::sample(double seconds, Pose& pose) const {
  PoseCurve(frames_).sample(seconds, pose);
}

GroundFrame MixMotion::poseFrameAt(double seconds) const {
  Pose pose;
  sample(seconds, pose);
  BodyFrame frame;
  body_->globals(pose, frame);
  return groundFrameOf(*body_, frame);
}

GroundFrame MixMotion::groundAt(double seconds) const {
  GroundFrame ground = poseFrameAt(seconds);
  ground.heading += swayAt(sways_, seconds / frames_.frameSeconds);
  return ground;
}

GroundFrame MixMotion::groundAt(double seconds, const BodyFrame& frame) const {
  GroundFrame ground = groundFrameOf(*body_, frame);
  ground.heading += swayAt(sways_, seconds / frames_.frameSeconds);
  return ground;
}

void MixMotion::readSteps() {
  footfalls_ = footfallsOf(*body_, frames_);
  std::vector<double> headings;
  BodyFrame frame;
  for (const Pose& pose : frames_.poses) {
    body_->globals(pose, frame);
    const double heading = groundFrameOf(*body_, frame).heading;
    headings.push_back(headings.empty() ? heading
                                        : headings.back() + std::remainder(heading - headings.back(), 2 * kPi));
  }
  sways_ = swaysOf(headings, strideSeconds(footfalls_) / frames_.frameSeconds);
}

bool MixMotion::loops() const {
  if (frames_.poses.size() < 4) return false;
  const double limit = kLoopError * body_->setup().targetHipHeight;
  return squaredDistance(positionsInBody(*body_, *this, 0), positionsInBody(*body_, *this, duration())) <=
         limit * limit;
}

MixMotion MixMotion::repeated(int times) const {
  MixMotion result = *this;
  const double length = duration();
  const GroundFrame start = poseFrameAt(0);
  const GroundStep step = stepBetween(start, poseFrameAt(length));
  GroundFrame at = start;
  const PoseSequence once = frames_;
  for (int i = 1; i < times; ++i) {
    at = moved(at, step);
    result.frames_.poses.pop_back();
    for (Pose pose : once.poses) {
      enterFrame(*body_, start, pose);
      leaveFrame(*body_, at, pose);
      result.frames_.poses.push_back(std::move(pose));
    }
    for (std::size_t f = 0; f < feet_.size(); ++f) {
      std::vector<TimeSpan>& spans = result.feet_[f].planted;
      for (const TimeSpan& span : feet_[f].planted) {
        const double from = i * length + span.from, to = i * length + span.to;
        if (!spans.empty() && from - spans.back().to < 1.5 * frames_.frameSeconds) {
          spans.back().to = to;
        } else {
          spans.push_back({from, to});
        }
      }
    }
  }
  result.readSteps();
  return result;
}

}  // namespace limber
