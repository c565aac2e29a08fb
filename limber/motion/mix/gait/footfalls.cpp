#include "limber/motion/mix/gait/footfalls.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace limber {

namespace {

constexpr double kSwing = 0.2;      // hip heights; 0.1 to 0.4; of a foot, there and back; set by hand
constexpr double kOnTheSpot = 0.1;  // hip heights a second; 0.05 to 0.3; a slower body goes nowhere; set by hand

// Where it goes on the whole, in its own frame.
Vec3 directionOf(const std::vector<GroundFrame>& ground, double frameSeconds, double hipHeight) {
  Vec3 displacement = Vec3::Zero();
  for (std::size_t f = 1; f < ground.size(); ++f) {
    const GroundStep step = stepBetween(ground[f - 1], ground[f]);
    displacement += Vec3(step.x, 0, step.z);
  }
  const double seconds = static_cast<double>(ground.size() - 1) * frameSeconds;
  return displacement.norm() > kOnTheSpot * hipHeight * seconds ? Vec3(displacement.normalized()) : Vec3(Vec3::UnitZ());
}

// Where between the frames before and after the value is largest, in frames from the middle.
double topOf(double before, double top, double after) {
  const double curvature = before - 2 * top + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
}

// Largest values from which it falls by `swing` before and behind, but for ends: in frames.
std::vector<double> topsOf(const std::vector<double>& values, double swing) {
  std::vector<double> tops;
  std::size_t most = 0, least = 0;
  bool rises = false;  // towards a top that has not been passed
  bool known = false;  // whether it rises or falls
  for (std::size_t f = 1; f < values.size(); ++f) {
    if (values[f] > values[most]) most = f;
    if (values[f] < values[least]) least = f;
    if ((rises || !known) && values[f] < values[most] - swing) {
      if (rises) tops.push_back(static_cast<double>(most) + topOf(values[most - 1], values[most], values[most + 1]));
      rises = false;
      known = true;
      least = f;
    } else if ((!rises || !known) && values[f] > values[least] + swing) {
      rises = known = true;
      most = f;
    }
  }
  return tops;
}

}  // namespace

std::vector<Footfall> footfallsOf(const MixBody& body, const PoseSequence& frames) {
  const double hipHeight = body.setup().targetHipHeight;
  const std::size_t legs = body.legs().size();
  std::vector<GroundFrame> ground;
  std::vector<std::vector<Vec3>> feet(legs);  // of each leg, by frame, from the pelvis
  BodyFrame frame;
  for (const Pose& pose : frames.poses) {
    body.globals(pose, frame);
    ground.push_back(groundFrameOf(body, frame));
    for (std::size_t i = 0; i < legs; ++i) {
      const Vec3 displacement = frame.positions[body.legs()[i].end] - ground.back().position();
      feet[i].push_back(ground.back().turn().conjugate() * displacement);
    }
  }
  const Vec3 ahead = directionOf(ground, frames.frameSeconds, hipHeight);
  std::vector<Footfall> falls;
  for (std::size_t i = 0; i < legs; ++i) {
    std::vector<double> displacement;
    for (const Vec3& foot : feet[i]) displacement.push_back(foot.dot(ahead));
    for (const double top : topsOf(displacement, kSwing * hipHeight)) {
      falls.push_back({body.legs()[i].end, top * frames.frameSeconds});
    }
  }
  std::sort(falls.begin(), falls.end(), [](const Footfall& a, const Footfall& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.foot < b.foot;
  });
  return falls;
}

}  // namespace limber
