#include "limber/rigging/transfer/surface_gaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "limber/character/anatomy/body_part.h"
#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

struct GapSum {
  double area = 0, square = 0, beyond = 0;

  void add(double vertexArea, double percent) {
    area += vertexArea;
    square += vertexArea * percent * percent;
    if (percent > kGap) beyond += vertexArea;
  }
  double rms() const { return area > 0 ? std::sqrt(square / area) : 0; }
  double partBeyond() const { return area > 0 ? beyond / area : 0; }
};

// The distance that 95 % of the area lie within.
double percentileOf(const std::vector<double>& percents, const std::vector<double>& areas, double all) {
  std::vector<std::size_t> order(percents.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return percents[a] < percents[b]; });
  double sum = 0;
  for (const std::size_t v : order) {
    sum += areas[v];
    if (sum >= 0.95 * all) return percents[v];
  }
  return 0;
}

}  // namespace

SurfaceGaps measureGaps(const TriMesh& target, std::span<const SurfacePoint> points, const Anatomy& anatomy,
                        const SkinWeights& weights, double height) {
  const std::vector<double> areas = vertexAreas(target);
  std::vector<double> percents(points.size());
  std::vector<std::string> labels;
  for (Index j = 0; j < anatomy.partOf.size(); ++j) labels.push_back(labelOf(anatomy, j));
  GapSum all;
  std::map<std::string, GapSum> parts;
  SurfaceGaps result;
  for (Index v = 0; v < points.size(); ++v) {
    percents[v] = 100 * (points[v].position - target.position(v)).norm() / height;
    if (areas[v] > 0) result.worst = std::max(result.worst, percents[v]);
    all.add(areas[v], percents[v]);
    const std::string& label = labels[weights.jointsOf(v)[0]];
    parts[label.empty() ? "other" : label].add(areas[v], percents[v]);
  }
  result.rms = all.rms();
  result.beyond = all.partBeyond();
  result.p95 = percentileOf(percents, areas, all.area);
  for (const auto& [name, sum] : parts) {
    if (sum.area > 0) result.parts.push_back({name, sum.area / all.area, sum.rms(), sum.partBeyond()});
  }
  std::stable_sort(result.parts.begin(), result.parts.end(),
                   [](const PartGap& a, const PartGap& b) { return a.beyond > b.beyond; });
  return result;
}

}  // namespace limber
