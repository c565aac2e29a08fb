#include "limber/rigging/templates/arm_flatness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "limber/rigging/body/body_section.h"

namespace limber {

namespace {

constexpr double kArmSeedReach = 0.04;  // heights

// The ratio of the spreads of a cut along its longest direction and across that.
double flatnessOf(const BodySection& section) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& [u, v] : section.cells) mean += Eigen::Vector2d(u, v);
  mean /= static_cast<double>(section.cells.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Identity() / 12;  // of one cell
  for (const auto& [u, v] : section.cells) {
    const Eigen::Vector2d off = Eigen::Vector2d(u, v) - mean;
    spread += off * off.transpose() / static_cast<double>(section.cells.size());
  }
  const double half = 0.5 * spread.trace();
  const double apart = std::sqrt(std::max(0.0, half * half - spread.determinant()));
  return std::sqrt((half + apart) / (half - apart));
}

}  // namespace

double armFlatness(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions, const BodyVolume& body,
                   const AnatomicalFrame& frame) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::string side : {"left", "right"}) {
    for (const auto& [from, to] : {std::pair("UpperArm", "LowerArm"), std::pair("LowerArm", "Hand")}) {
      const std::optional<Index> start = skeleton.find(side + from), end = skeleton.find(side + to);
      if (!start || !end) return 1;
      const Vec3 bone = positions[*end] - positions[*start];
      if (!(bone.norm() > 1e-6)) return 1;
      const BodySection cut =
          sectionAt(body, frame, 0.5 * (positions[*start] + positions[*end]), bone.normalized(), kArmSeedReach);
      if (cut.empty()) return 1;
      least = std::min(least, flatnessOf(cut));
    }
  }
  return least;
}

}  // namespace limber
