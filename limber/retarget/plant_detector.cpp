#include "limber/retarget/plant_detector.h"

#include <algorithm>

namespace limber {

namespace {
// Seconds over which speed is measured, at least one frame: recordings at 120 frames a second tremble from frame to
// frame by more than a walk's slowest feet move.
constexpr double kWindow = 0.045;
}  // namespace

void PlantDetector::reset() {
  count_ = 0;
  planted_ = false;
}

Vec3 PlantDetector::velocity() const {
  const auto at = [&](std::size_t back) -> const Seen& { return seen_[(count_ - 1 - back) % seen_.size()]; };
  const std::size_t most = std::min(count_, seen_.size());
  double seconds = 0;
  std::size_t back = 0;
  // Frames' times are no exact fractions: a half frame more or less is the same window.
  while (back + 1 < most && seconds + 0.5 * at(back).seconds < kWindow) seconds += at(back++).seconds;
  return seconds > 0 ? Vec3((at(0).position - at(back).position) / seconds) : Vec3(Vec3::Zero());
}

bool PlantDetector::next(const Vec3& position, double height, double seconds) {
  seen_[count_++ % seen_.size()] = {position, seconds};
  const double speed = velocity().norm() / hipHeight_, high = height / hipHeight_;
  planted_ = planted_ ? speed < thresholds_.leaveSpeed && high < thresholds_.leaveHeight
                      : speed < thresholds_.enterSpeed && high < thresholds_.enterHeight;
  return planted_;
}

}  // namespace limber
