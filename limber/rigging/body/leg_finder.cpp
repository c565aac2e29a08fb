#include "limber/rigging/body/leg_finder.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

constexpr double kLegSeedReach = 0.04;  // heights
constexpr double kLowestParting = 0.3;  // of the height from ankle to hip as read: legs that part lower are no legs
constexpr int kStaysTogether = 3;       // cuts

}  // namespace

bool LegFinder::findParting() {
  const double step = body_.distance->spacing() / frame_.height;
  const double ankle = std::max(positions_[legs_[0].ankle].y(), positions_[legs_[1].ankle].y()) + 0.02;
  const double hip = std::max(positions_[legs_[0].hip].y(), positions_[legs_[1].hip].y());
  int together = 0;
  for (double y = ankle; y < hip + 0.15; y += step) {
    std::array<BodySection, 2> cut;
    for (int side = 0; side < 2; ++side)
      cut[side] = sectionAt(body_, frame_, seed(side, y), Vec3::UnitY(), kLegSeedReach);
    if (cut[0].empty() || cut[1].empty()) continue;
    if (cut[0].contains(cut[1].center) || cut[0].center.x() <= cut[1].center.x()) {
      if (++together == kStaysTogether) {
        parting_ = y - (kStaysTogether - 1) * step;
        return known() && parting_ > ankle + kLowestParting * (hip - ankle);
      }
      continue;
    }
    together = 0;
    for (int side = 0; side < 2; ++side) sections_[side].push_back(cut[side]);
  }
  return false;
}

double LegFinder::halfWidth(int side) const {
  double sum = 0;
  const std::size_t count = std::min<std::size_t>(4, sections_[side].size());
  for (std::size_t i = 0; i < count; ++i) {
    const BodySection& section = sections_[side][sections_[side].size() - 1 - i];
    sum += 0.5 * (section.high - section.low) / static_cast<double>(count);
  }
  return sum;
}

double LegFinder::halfDepth(int side, double y) const {
  const std::vector<BodySection>& cuts = sections_[side];
  const auto nearest = std::min_element(cuts.begin(), cuts.end(), [&](const BodySection& a, const BodySection& b) {
    return std::abs(a.center.y() - y) < std::abs(b.center.y() - y);
  });
  return nearest == cuts.end() ? 0 : nearest->halfDepth();
}

Vec3 LegFinder::middle(int side, double y) const {
  const std::vector<BodySection>& cuts = sections_[side];
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (const BodySection& cut : cuts) {
    const double off = (cut.center.y() - std::min(y, cuts.back().center.y() - 0.01)) / 0.02;
    const double weight = std::exp(-off * off);
    sum += weight * cut.center;
    weights += weight;
  }
  return weights > 1e-6 ? Vec3(sum.x() / weights, y, sum.z() / weights)
                        : Vec3(cuts.front().center.x(), y, cuts.front().center.z());
}

// Upwards from the last cut; first on the shin as it was read.
Vec3 LegFinder::seed(int side, double y) const {
  if (!sections_[side].empty()) {
    const Vec3& last = sections_[side].back().center;
    return {last.x(), y, last.z()};
  }
  const Vec3 &knee = positions_[legs_[side].knee], &ankle = positions_[legs_[side].ankle];
  const double part = std::clamp((y - ankle.y()) / std::max(knee.y() - ankle.y(), 1e-3), 0.0, 1.0);
  Vec3 position = ankle + part * (knee - ankle);
  position.y() = y;
  return position;
}

}  // namespace limber
