#include "limber/evaluate/motion/ik_page.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limber/evaluate/group_summary.h"

namespace limber {

namespace {

constexpr std::string_view kColors[] = {"#1b6ca8", "#d1495b", "#edae49", "#3c9d6d", "#7b4ea3", "#00798c",
                                        "#8d5a3a", "#e07be0", "#444444", "#9aa31b", "#5b8def"};

std::string svgStart(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      width, height);
}

std::string text(double x, double y, std::string_view words, std::string_view attributes = {}) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, words);
}

// From red over yellow to green, pale enough for dark letters; the scale opens up towards everything solved.
std::string colorOf(double fraction) {
  const double good = fraction >= 1 ? 1 : 0.9 * fraction * fraction;
  const double red = good < 0.5 ? 244 : 244 - (good - 0.5) * 2 * 110;
  const double green = good < 0.5 ? 150 + good * 2 * 70 : 220;
  return fmt::format("rgb({:.0f},{:.0f},140)", red, green);
}

// A panel with both axes logarithmic.
struct PlotAxes {
  double left, top, width, height;
  double minX = 2.5, maxX = 120, minY = 0.1, maxY = 1000;

  double x(double value) const { return left + width * std::log(value / minX) / std::log(maxX / minX); }
  double y(double value) const {
    return top + height * (1 - std::log(std::clamp(value, minY, maxY) / minY) / std::log(maxY / minY));
  }
};

std::string grid(const PlotAxes& axes, std::string_view title) {
  std::string svg = text(axes.left, axes.top - 10, title, "font-weight=\"bold\"");
  for (const int joints : {3, 10, 30, 100}) {
    const double x = axes.x(joints);
    svg +=
        fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#dddddd\"/>\n", x, axes.top, axes.top + axes.height);
    svg += text(x, axes.top + axes.height + 16, fmt::format("{}", joints), "text-anchor=\"middle\"");
  }
  for (double micros = axes.minY; micros <= axes.maxY * 1.01; micros *= 10) {
    const double y = axes.y(micros);
    svg += fmt::format("<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" stroke=\"#dddddd\"/>\n", axes.left, y,
                       axes.left + axes.width);
    svg += text(axes.left - 6, y + 4, fmt::format("{:g}", micros), "text-anchor=\"end\"");
  }
  return svg + text(axes.left + axes.width / 2, axes.top + axes.height + 34, "joints", "text-anchor=\"middle\"");
}

std::string timeLine(const PlotAxes& axes, std::span<const IkScore> scores, const std::string& method,
                     std::string_view ending, std::string_view color) {
  std::string points, dots;
  for (const int joints : {3, 10, 30, 100}) {
    const IkScore* score = findIkScore(scores, method, fmt::format("chain-{} {}", joints, ending));
    if (!score) continue;
    const double x = axes.x(joints), y = axes.y(score->medianMicros);
    points += fmt::format("{}{:.1f} {:.1f}", points.empty() ? "M" : "L", x, y);
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, color);
  }
  if (points.empty()) return {};
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", points, color) + dots;
}

// What was aimed at, and where the table has it.
struct Goal {
  std::string_view what, method, set;
  double wantedMicros;  // 0: the goal is a fraction
  double targetFraction;
  std::string_view elsewhere;
};

constexpr Goal kGoals[] = {
    {"limb of two bones, analytic", "two-bone", kClosedFormSet, 0.12, 0, "0.116 to 0.126 µs (ozz-animation)"},
    {"10 joints to a millionth", "fabrik", "chain-10 millionth", 3, 0, "3.5 µs"},
    {"10 joints to a millionth", "ccd", "chain-10 millionth", 30, 0, "77 µs"},
    {"10 joints to a millionth", "pseudo-inverse", "chain-10 millionth", 0, 1, "21 µs"},
    {"10 joints to a millionth", "jacobian-transpose", "chain-10 millionth", 0, 0.99, "76 µs, 89 % solved"},
    {"10 joints to a millionth", "dls", "chain-10 millionth", 0, 1, "197 µs, 1 % solved"},
    {"10 joints to a millionth", "sdls", "chain-10 millionth", 0, 1, ""},
    {"60 joints, 5 effectors, frame to frame", "whole-body", "humanoid frames", 150, 0, ""},
    {"60 joints, 5 effectors, limits", "whole-body", "humanoid reachable limits", 0, 0.99, ""},
};

Table goalTable(std::span<const IkScore> scores) {
  Table table{{words("problem"), words("method"), number("aim", 0), number("here", 0), number("elsewhere", 0)}};
  for (const Goal& goal : kGoals) {
    const IkScore* score = findIkScore(scores, goal.method, goal.set);
    if (!score) continue;
    table.add({goal.what, goal.method,
               goal.wantedMicros > 0 ? fmt::format("{} µs", goal.wantedMicros)
                                     : fmt::format("{:g} % solved", 100 * goal.targetFraction),
               fmt::format("{:.2f} µs, {:.1f} % solved", score->medianMicros, 100 * score->fraction()),
               goal.elsewhere.empty() ? Cell() : Cell(goal.elsewhere)});
  }
  return table;
}

}  // namespace

std::string ikSolvedPlot(std::span<const IkScore> scores) {
  const std::vector<std::string> sets = namesIn(scores, &IkScore::set), methods = namesIn(scores, &IkScore::method);
  constexpr double kLeft = 200, kTop = 40, kWidth = 100, kHeight = 20;
  std::string svg = svgStart(kLeft + kWidth * static_cast<double>(methods.size()) + 10,
                             kTop + kHeight * static_cast<double>(sets.size()) + 10);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    svg += text(kLeft + kWidth * (static_cast<double>(m) + 0.5), kTop - 10, methods[m],
                "text-anchor=\"middle\" font-size=\"9.5\"");
  }
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const double y = kTop + kHeight * static_cast<double>(s);
    svg += text(kLeft - 8, y + 14, sets[s], "text-anchor=\"end\"");
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const IkScore* score = findIkScore(scores, methods[m], sets[s]);
      if (!score) continue;
      const double x = kLeft + kWidth * static_cast<double>(m);
      svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x + 1,
                         y + 1, kWidth - 2, kHeight - 2, colorOf(score->fraction()));
      svg += text(x + kWidth / 2, y + 14, fmt::format("{:.1f}", 100 * score->fraction()), "text-anchor=\"middle\"");
    }
  }
  return svg + "</svg>\n";
}

std::string ikTimePlot(std::span<const IkScore> scores) {
  const std::vector<std::string> methods = namesIn(scores, &IkScore::method);
  const PlotAxes free{60, 40, 320, 300}, limited{450, 40, 320, 300};
  std::string svg = svgStart(930, 390);
  svg += grid(free, "Reachable targets, no limits: median µs") + grid(limited, "Reachable targets, limits: median µs");
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const std::string_view color = kColors[m % std::size(kColors)];
    svg += timeLine(free, scores, methods[m], "reachable", color);
    svg += timeLine(limited, scores, methods[m], "reachable limits", color);
    const double y = 60 + 20 * static_cast<double>(m);
    svg += fmt::format("<rect x=\"790\" y=\"{:.1f}\" width=\"14\" height=\"4\" fill=\"{}\"/>\n", y - 6, color);
    svg += text(810, y, methods[m]);
  }
  return svg + "</svg>\n";
}

std::string ikPage(std::span<const IkScore> scores, const std::string& plotFolder) {
  const std::string prefix = plotFolder.empty() ? "" : plotFolder + "/";
  const Index problems = scores.empty() ? 0 : scores.front().problems;
  return fmt::format(
      "# Inverse kinematics: the methods compared\n\n"
      "Made by `limber evaluate ik --problems {} --plot FOLDER -o PAGE` (`./dev docs`), one thread, on the machine "
      "that\n"
      "made this page. Every method has the same {} problems of each kind: chains of 3, 10, 30 and 100 joints and a\n"
      "humanoid of 60 joints whose hands, feet and head have targets. Reachable targets are where another allowed "
      "pose\n"
      "has the effectors; borderline ones at 97 to 99.9 % of a chain's length or, with limits, where joints stand at\n"
      "their bounds; unreachable ones count as solved when the method says so. Solved is within a thousandth of the\n"
      "chain's length (`millionth`: a millionth); `frames`: from the answer for the frame before, without restarts;\n"
      "`{}`: the closed form of two bones without a solver round it. What a body shall do besides\n"
      "reaching (look, keep out, balance, ...), with priorities, is told in [tasks.md](tasks.md).\n\n"
      "**Best with limits: {}.**\n\n"
      "![Share solved, in percent]({}{})\n\n"
      "![Median time of a solve]({}{})\n\n"
      "## Aims\n\n{}\n"
      "## All figures\n\n{}",
      problems, problems, kClosedFormSet, bestIkMethodWithLimits(scores), prefix, kIkPlotFiles.solved, prefix,
      kIkPlotFiles.time, toMarkdown(goalTable(scores)), toMarkdown(ikScoreTable(scores)));
}

}  // namespace limber
