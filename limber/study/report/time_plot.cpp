#include "limber/study/report/time_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "limber/report/escaped_text.h"

namespace limber {

namespace {

constexpr double kWidth = 560, kHeight = 300, kLeft = 70, kRight = 20, kTop = 20, kBottom = 45;

struct Point {
  double seconds, value, low, high;
  std::size_t rank;
};

std::vector<Point> pointsOf(const Ranking& ranking) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < ranking.scores.size(); ++i) {
    const MethodScore& score = ranking.scores[i];
    if (score.seconds <= 0 || !std::isfinite(score.value.median)) continue;
    const auto ending = [&](double end) { return std::isfinite(end) ? end : score.value.median; };
    points.push_back({score.seconds, score.value.median, ending(score.value.low), ending(score.value.high), i + 1});
  }
  return points;
}

// A span of values, laid on a span of the drawing.
struct Axis {
  double least, most, from, to;
  double at(double value) const {
    return most > least ? from + (to - from) * (value - least) / (most - least) : 0.5 * (from + to);
  }
};

std::string label(double x, double y, std::string_view text, std::string_view anchor) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, htmlText(text));
}

// At most about six of 0.01, 0.02, 0.05, 0.1, ... within the axis, else its ends.
std::vector<double> timeTicks(double least, double most) {
  std::vector<double> ticks;
  for (double decade = 1e-4; decade < 1e6; decade *= 10) {
    for (const double step : {1.0, 2.0, 5.0}) {
      if (decade * step >= least && decade * step <= most) ticks.push_back(decade * step);
    }
  }
  if (ticks.size() < 2) return {least, most};
  return ticks;
}

}  // namespace

std::string timePlot(const Ranking& ranking) {
  const std::vector<Point> points = pointsOf(ranking);
  if (points.size() < 2 || ranking.measure->source == MeasureSource::kClock) return {};
  double least = points[0].low, most = points[0].high, fastest = points[0].seconds, slowest = fastest;
  for (const Point& point : points) {
    least = std::min(least, point.low);
    most = std::max(most, point.high);
    fastest = std::min(fastest, point.seconds);
    slowest = std::max(slowest, point.seconds);
  }
  constexpr double kMargin = 1.15;  // of time, on either side
  fastest /= kMargin;
  slowest *= kMargin;
  const Axis x{std::log(fastest), std::log(slowest), kLeft, kWidth - kRight};
  const bool isMoreBetter = ranking.measure->better == Better::kMore;
  const Axis y{least, most, isMoreBetter ? kHeight - kBottom : kTop, isMoreBetter ? kTop : kHeight - kBottom};
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" aria-label=\"Time against {2}; numbers "
      "are "
      "ranks\">\n<path class=\"axis\" d=\"M{3} {4}V{5}H{6}\"/>",
      kWidth, kHeight, htmlText(ranking.measure->label), kLeft, kTop, kHeight - kBottom, kWidth - kRight);
  for (const double tick : timeTicks(fastest, slowest)) {
    svg += label(x.at(std::log(tick)), kHeight - kBottom + 16, fmt::format("{:.2g}", tick), "middle");
  }
  for (const double tick : {least, most}) svg += label(kLeft - 6, y.at(tick) + 4, fmt::format("{:.3g}", tick), "end");
  svg += label(0.5 * (kLeft + kWidth), kHeight - 8, "time (s); up is better", "middle");
  for (const Point& point : points) {
    const double px = x.at(std::log(point.seconds)), py = y.at(point.value);
    svg +=
        fmt::format("\n<path class=\"axis\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>", px, y.at(point.low), y.at(point.high));
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"#2f7fd1\"/>", px, py);
    svg += label(px + 7, py - 5, std::to_string(point.rank), "start");
  }
  return svg + "</svg>\n";
}

}  // namespace limber
