#include "limber/retarget/plant_detector.h"

#include <cmath>

namespace limber {

namespace {
constexpr double kMemory = 0.015;  // seconds; noise of mocap at 120 frames a second is well above a walk's slowest feet
}

void PlantDetector::reset() {
  before_.reset();
  velocity_ = Vec3::Zero();
  planted_ = false;
}

bool PlantDetector::next(const Vec3& position, double height, double seconds) {
  if (before_ && seconds > 0) {
    const double keep = std::exp(-seconds / kMemory);
    velocity_ = keep * velocity_ + (1 - keep) * (position - *before_) / seconds;
  }
  before_ = position;
  const double speed = velocity_.norm() / hipHeight_, high = height / hipHeight_;
  planted_ = planted_ ? speed < thresholds_.leaveSpeed && high < thresholds_.leaveHeight
                      : speed < thresholds_.enterSpeed && high < thresholds_.enterHeight;
  return planted_;
}

}  // namespace limber
