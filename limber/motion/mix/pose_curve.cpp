#include "limber/motion/mix/pose_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limber {

namespace {

// Cosine of half an angle; 0.7 to 0.98; below it, by more than 45 degrees in a frame, a joint has flipped; set by hand.
constexpr double kFlip = 0.924;

// How much the frames at -1, 0, 1, 2 count between 0 and 1. At an end of the motion the speed is that of the parabola
// through the last three.
std::array<double, 4> countsAt(double u, bool first, bool last) {
  const double from = u * (1 - u) * (1 - u), to = -u * u * (1 - u);  // of the speeds at both ends
  const double there = u * u * (3 - 2 * u);
  std::array<double, 4> counts = {0, 1 - there, there, 0};
  const auto add = [&](double fraction, std::array<double, 4> speed) {
    for (std::size_t i = 0; i < 4; ++i) counts[i] += fraction * speed[i];
  };
  const bool alone = first && last;
  add(from, alone   ? std::array{0.0, -1.0, 1.0, 0.0}
            : first ? std::array{0.0, -1.5, 2.0, -0.5}
                    : std::array{-0.5, 0.0, 0.5, 0.0});
  add(to, alone  ? std::array{0.0, -1.0, 1.0, 0.0}
          : last ? std::array{0.5, -2.0, 1.5, 0.0}
                 : std::array{0.0, -0.5, 0.0, 0.5});
  return counts;
}

}  // namespace

CurveWeights curveWeights(double at, std::size_t frameCount) {
  if (frameCount == 1) return {{0, 0, 0, 0}, {0, 1, 0, 0}};
  const std::size_t k = std::min(static_cast<std::size_t>(at), frameCount - 2);
  const bool isFirst = k == 0, isLast = k + 2 == frameCount;
  return {{isFirst ? 0 : k - 1, k, k + 1, isLast ? k + 1 : k + 2},
          countsAt(at - static_cast<double>(k), isFirst, isLast)};
}

void PoseCurve::sample(double seconds, Pose& pose) const {
  const std::vector<Pose>& poses = frames_.poses;
  const double last = static_cast<double>(poses.size() - 1), at = std::clamp(seconds / frames_.frameSeconds, 0.0, last);
  const double near = std::round(at);
  if (std::abs(at - near) < kWholeFrame) {
    pose = poses[static_cast<std::size_t>(near)];
    return;
  }
  const auto k = static_cast<std::size_t>(at);
  const CurveWeights curve = curveWeights(at, poses.size());
  pose = poses[k];
  for (std::size_t j = 0; j < pose.locals.size(); ++j) {
    Transform& local = pose.locals[j];
    const Quat before = local.rotation;
    Eigen::Vector4d turned = Eigen::Vector4d::Zero();
    local.translation.setZero();
    bool flips = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const Transform& other = poses[curve.frames[i]].locals[j];
      const double alike = other.rotation.dot(before);
      flips = flips || (curve.weights[i] != 0 && std::abs(alike) < kFlip);
      local.translation += curve.weights[i] * other.translation;
      turned += (alike < 0 ? -curve.weights[i] : curve.weights[i]) * other.rotation.coeffs();
    }
    local.rotation = flips ? poses[static_cast<std::size_t>(near)].locals[j].rotation : Quat(turned.normalized());
    local.scale =
        poses[k].locals[j].scale + (at - std::floor(at)) * (poses[k + 1].locals[j].scale - poses[k].locals[j].scale);
  }
}

}  // namespace limber
