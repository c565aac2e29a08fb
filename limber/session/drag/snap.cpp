#include "limber/session/drag/snap.h"

#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/session/drag/standing_feet.h"
#include "limber/session/rigged_model.h"

namespace limber {

namespace {

constexpr double kStepsAlongModel = 100;

}  // namespace

double roundStep(double length) {
  if (!(length > 0) || !std::isfinite(length)) return 1;
  const double decade = std::pow(10, std::floor(std::log10(length)));
  double best = decade;
  for (const double times : {2.0, 5.0, 10.0}) {
    const double step = times * decade;
    if (std::abs(std::log(step / length)) < std::abs(std::log(best / length))) best = step;
  }
  return best;
}

DragSnap snapOf(const RiggedModel& rig, Index joint) {
  DragSnap snap;
  snap.step = roundStep(longestSide(rig) / kStepsAlongModel);
  snap.up = rig.anatomy().axes.up;
  for (const PinnedTarget& foot : standingFeet(rig, rig.home)) {
    if (foot.joint == joint) snap.ground = snap.up.dot(foot.position);
  }
  return snap;
}

Vec3 snapPosition(const DragSnap& snap, const Vec3& position) {
  Vec3 snapped = snap.step * (position / snap.step).array().round();
  const double height = snap.up.dot(position);
  if (snap.ground && std::abs(height - *snap.ground) <= snap.step) {
    snapped += (*snap.ground - snap.up.dot(snapped)) * snap.up;
  }
  return snapped;
}

Quat snapTurn(const DragSnap& snap, const Quat& turn) {
  const Eigen::AngleAxisd about(turn);
  const double step = snap.degrees * kDegree;
  return Quat(Eigen::AngleAxisd(step * std::round(about.angle() / step), about.axis()));
}

double snapScale(double scale) {
  return std::max(1.0, std::round(10 * scale)) / 10;
}

}  // namespace limber
