#include "limber/motion/limbs/contacts/plant_detector.h"

#include <algorithm>

namespace limber {

namespace {
// Seconds; 0.03 to 0.07; over which speed is measured, at least one frame: recordings at 120 frames a second tremble
// from frame to frame by more than a walk's slowest feet move; by jerk on the shared motions.
constexpr double kWindow = 0.045;
}  // namespace

void PlantDetector::reset() {
  count_ = 0;
  planted_ = false;
}

Vec3 PlantDetector::velocity(std::size_t skipped) const {
  if (skipped >= count_) return Vec3::Zero();
  const std::size_t last = count_ - 1 - skipped;
  const auto at = [&](std::size_t back) -> const Seen& { return seen_[(last - back) % seen_.size()]; };
  const std::size_t most = std::min(count_, seen_.size()) - skipped;
  double seconds = 0;
  std::size_t back = 0;
  // Frames' times are no exact fractions: a half frame more or less is the same window.
  while (back + 1 < most && seconds + 0.5 * at(back).seconds < kWindow) seconds += at(back++).seconds;
  return seconds > 0 ? Vec3((at(0).position - at(back).position) / seconds) : Vec3(Vec3::Zero());
}

// Of a point that slows down: in half a window, if it goes on to do so.
double PlantDetector::speedAhead() const {
  const double speed = velocity(0).norm();
  const double seconds = seen_[(count_ - 1) % seen_.size()].seconds;
  if (!(seconds > 0)) return speed;
  const auto half = static_cast<std::size_t>(std::max(1.0, std::round(0.5 * kWindow / seconds)));
  if (half + 1 >= std::min(count_, seen_.size() / 2)) return speed;
  return std::min(speed, 2 * speed - velocity(half).norm());
}

bool PlantDetector::next(const Vec3& position, double height, double seconds) {
  seen_[count_++ % seen_.size()] = {position, seconds};
  const double speed = speedAhead() / hipHeight_, high = height / hipHeight_;
  const bool rises = velocity(0).y() > thresholds_.leaveRise * hipHeight_;
  planted_ = planted_ ? speed < thresholds_.leaveSpeed && high < thresholds_.leaveHeight && !rises
                      : speed < thresholds_.enterSpeed && high < thresholds_.enterHeight;
  return planted_;
}

}  // namespace limber
