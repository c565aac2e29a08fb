#include "limber/limbs/near_ground.h"

#include <algorithm>

#include "limber/limbs/smooth.h"

namespace limber {

namespace {

// Hip heights.
constexpr double kNear = 0.02, kFar = 0.6;
constexpr double kSoftGround = 0.002;
constexpr double kTrembles = 0.03, kSoftHeld = 0.01;

double shareOf(const SolePoint& point) {
  return smoothStep((kFar - point.source) / (kFar - kNear));
}

}  // namespace

double nearGround(std::span<const SolePoint> points) {
  double sum = 0;
  for (const SolePoint& point : points) sum += shareOf(point);
  return smoothStep(sum);
}

double riseNearGround(std::span<const SolePoint> points) {
  double sum = 0, shares = 0;
  for (const SolePoint& point : points) {
    const double share = shareOf(point);
    sum += share * share * (softPositive(point.source, kSoftGround) - point.target);
    shares += share;
  }
  return shares > 0 ? sum / shares : 0;
}

double heldHeight(double sourceHeight) {
  return softPositive(sourceHeight - kTrembles, kSoftHeld);
}

}  // namespace limber
