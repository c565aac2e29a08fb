#include "limber/rigging/body/feet_direction.h"

#include <algorithm>
#include <cmath>

#include "limber/rigging/body/body_section.h"

namespace limber {

namespace {

// Heights.
constexpr double kSole = 0.02;
constexpr double kAnkle = 0.09;
constexpr double kShin = 0.14;
constexpr double kFootSeedReach = 0.05;
constexpr double kWidestLeg = 0.025;                       // square heights of a cut: not of both legs, nor of a skirt
constexpr double kMaxLean = 0.35;                          // of the shin, to front or back for each height upwards
constexpr double kSmallestFoot = 0.45, kLargestFoot = 12;  // cuts of the leg: not a heel alone

}  // namespace

double feetForward(const BodyVolume& body, const AnatomicalFrame& frame, std::span<const Vec3> feet) {
  double sum = 0;
  int standing = 0;
  for (const Vec3& foot : feet) {
    const BodySection leg = sectionAt(body, frame, {foot.x(), kAnkle, foot.z()}, Vec3::UnitY(), kFootSeedReach);
    if (leg.empty() || leg.area > kWidestLeg) continue;
    const BodySection shin =
        sectionAt(body, frame, {leg.center.x(), kShin, leg.center.z()}, Vec3::UnitY(), kFootSeedReach);
    if (std::abs(shin.center.z() - leg.center.z()) > kMaxLean * (kShin - kAnkle)) continue;  // a step
    const BodySection print =
        sectionAt(body, frame, {leg.center.x(), kSole, leg.center.z()}, Vec3::UnitY(), kFootSeedReach);
    const double size = print.area / leg.area;
    if (size < kSmallestFoot || size > kLargestFoot || !(print.halfDepth() > 0)) continue;
    sum += std::clamp((print.center.z() - leg.center.z()) / print.halfDepth(), -1.0, 1.0);
    ++standing;
  }
  return standing > 0 ? sum / standing : 0;
}

}  // namespace limber
