#include "limber/rigging/body/body_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace limber {

bool BodySection::contains(const Vec3& position) const {
  const std::array<int, 2> at = {static_cast<int>(std::lround((position - origin).dot(across) / cell)),
                                 static_cast<int>(std::lround((position - origin).dot(along) / cell))};
  return std::binary_search(cells.begin(), cells.end(), at);
}

double BodySection::halfDepth() const {
  if (cells.empty()) return 0;
  const auto [nearest, farthest] =
      std::minmax_element(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  return 0.5 * cell * ((*farthest)[1] - (*nearest)[1]);
}

BodySection sectionAt(const BodyVolume& body, const AnatomicalFrame& frame, const Vec3& seed, const Vec3& normal,
                      double reach) {
  using Cell = std::array<int, 2>;
  BodySection section;
  section.origin = seed;
  section.across = std::abs(normal.x()) < 0.9 ? Vec3((Vec3::UnitX() - normal.x() * normal).normalized())
                                              : Vec3((Vec3::UnitY() - normal.y() * normal).normalized());
  section.along = section.across.cross(normal);
  section.cell = 0.5 * body.distance->spacing() / frame.height;
  const auto positionOf = [&](double across, double along) {
    return Vec3(seed + section.cell * (across * section.across + along * section.along));
  };
  const auto inside = [&](const Cell& at) { return body.distance->at(frame.fromBody(positionOf(at[0], at[1]))) < 0; };
  const int around = static_cast<int>(reach / section.cell);
  Cell nearest = {};
  int best = std::numeric_limits<int>::max();
  for (int i = -around; i <= around; ++i) {
    for (int k = -around; k <= around; ++k) {
      if (i * i + k * k >= best || !inside({i, k})) continue;
      best = i * i + k * k;
      nearest = {i, k};
    }
  }
  if (best == std::numeric_limits<int>::max()) return section;

  std::set<Cell> seen = {nearest};
  std::vector<Cell> waiting = {nearest};
  Vec3 sum = Vec3::Zero();
  while (!waiting.empty()) {
    const Cell at = waiting.back();
    waiting.pop_back();
    section.cells.push_back(at);
    sum += positionOf(at[0], at[1]);
    for (const auto& [di, dk] : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next = {at[0] + di, at[1] + dk};
      if (seen.count(next) == 0 && inside(next)) {
        seen.insert(next);
        waiting.push_back(next);
      }
    }
  }
  std::sort(section.cells.begin(), section.cells.end());
  section.low = section.cells.front()[0] * section.cell;
  section.high = section.cells.back()[0] * section.cell;
  section.area = static_cast<double>(section.cells.size()) * section.cell * section.cell;
  section.center = sum / static_cast<double>(section.cells.size());
  return section;
}

}  // namespace limber
