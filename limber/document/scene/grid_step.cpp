#include "limber/document/scene/grid_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "limber/core/types.h"

namespace limber {

namespace {

constexpr double kFloatStep = 0x1p-21;     // of the largest value: finer grids are single precision's own
constexpr std::size_t kSamples = 4096;     // values of one axis that are looked at
constexpr double kSure = 16;               // values farther apart than chance explains: the odds are exp(-16)
constexpr double kFewestSteps = 100;       // of a grid along its longest axis; 7 bits have 127
constexpr double kFairOdds = 0.6;          // of a value to lie on a grid by chance: more tells nothing
constexpr std::size_t kFewestLevels = 12;  // of values that lie on a grid: fewer may be round numbers
constexpr int kFewestBits = 8, kMaxBits = 16;
constexpr double kEqualSteps = 2;  // by how much steps along the axes differ at most, for lack of values

double declaredStep(const AccessorInfo& accessor) {
  if (accessor.type == ComponentType::kF32) return 0;
  if (!accessor.normalized) return 1;
  switch (accessor.type) {
    case ComponentType::kI8:
      return 1.0 / 127;
    case ComponentType::kU8:
      return 1.0 / 255;
    case ComponentType::kI16:
      return 1.0 / 32767;
    default:
      return 1.0 / 65535;
  }
}

// Different values along one axis.
struct AxisValues {
  double count = 0, range = 0;
  double gap = 0;  // the smallest between two of them, 0 where there is one
  double lowest = 0;
  double largest = 0;  // without its sign

  // Of `count` values thrown into the range the smallest gap is range / count^2 in the mean, exponentially distributed.
  bool keepApart() const {
    return gap * count * count > kSure * range && range >= kFewestSteps * gap && gap > kFloatStep * largest;
  }
};

AxisValues axisValues(std::span<const float> values, std::size_t axis) {
  const std::size_t points = values.size() / 3, step = 1 + points / kSamples;
  std::vector<float> sorted;
  for (std::size_t i = 0; i < points; i += step) sorted.push_back(values[3 * i + axis]);
  std::sort(sorted.begin(), sorted.end());
  AxisValues result;
  result.count = 1;
  if (sorted.empty()) return result;
  result.range = double{sorted.back()} - sorted.front();
  result.lowest = sorted.front();
  result.largest = std::max(std::abs(double{sorted.front()}), std::abs(double{sorted.back()}));
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double gap = double{sorted[i]} - sorted[i - 1];
    if (!(gap > 0)) continue;
    result.gap = result.count > 1 ? std::min(result.gap, gap) : gap;
    ++result.count;
  }
  return result;
}

// The step of the grid that the values show, the same along all axes; 0 where there is none.
double shownStep(const std::array<AxisValues, 3>& axes) {
  double least = std::numeric_limits<double>::infinity(), sure = 0;
  for (const AxisValues& axis : axes) {
    if (axis.gap > 0) least = std::min(least, axis.gap);
    if (axis.keepApart()) sure = std::max(sure, axis.gap);
  }
  return sure > 0 && sure < kEqualSteps * least ? least : 0;
}

// Whether all values lie on a grid of that step from the lowest along each axis on, more of them than chance explains.
// `error` is by how much two values may be farther apart than a multiple of it, or nearer.
bool liesOnGrid(std::span<const float> values, const std::array<AxisValues, 3>& axes, double step, double error) {
  const double odds = 2 * error / step;  // for a value that lies anywhere
  if (odds > kFairOdds) return false;
  std::set<std::pair<std::size_t, double>> met;  // axis and number of the step
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double steps = (double{values[i]} - axes[i % 3].lowest) / step;
    if (std::abs(steps - std::round(steps)) * step > error) return false;
    const bool isInside = steps > 0.5 && steps < axes[i % 3].range / step - 0.5;  // the ends are on it anyway
    if (isInside && met.size() < kSamples) met.insert({i % 3, std::round(steps)});
  }
  return met.size() >= kFewestLevels && -std::log(odds) * static_cast<double>(met.size()) > kSure;
}

// The step of a grid of so many bits over the longest side of the positions' own box, the coarsest that holds them all;
// 0 where none does. The grid begins at the box, or is symmetric about its middle (as normalised integers are).
double stepOfOwnBox(std::span<const float> values, const std::array<AxisValues, 3>& axes, double declared) {
  double longest = 0, largest = 0;
  for (const AxisValues& axis : axes) {
    longest = std::max(longest, axis.range);
    largest = std::max(largest, axis.largest);
  }
  if (!(longest > 0)) return 0;
  for (int bits = kFewestBits; bits <= kMaxBits; ++bits) {
    for (const double fewer : {1.0, 2.0}) {
      const double step = longest / (std::ldexp(1.0, bits) - fewer);
      if (liesOnGrid(values, axes, step, declared + kFloatStep * largest)) return step;
    }
  }
  return 0;
}

}  // namespace

double gridStep(std::span<const float> values, const AccessorInfo& accessor) {
  std::array<AxisValues, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) axes[i] = axisValues(values, i);
  const double declared = declaredStep(accessor), own = stepOfOwnBox(values, axes, declared);
  return std::max(declared, own > 0 ? own : shownStep(axes));
}

}  // namespace limber
