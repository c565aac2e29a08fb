// The evaluation of inverse kinematics as a page for the docs, with plots.
#pragma once

#include <span>
#include <string>

#include "limber/evaluate/motion/ik_evaluation.h"

namespace limber {

// A chart of the fraction solved: a row for each set of problems, a column for each method. SVG.
std::string ikSolvedPlot(std::span<const IkScore> scores);

// The median time of a solve over the number of joints, a line for each method, both axes logarithmic: chains with
// reachable targets, free and with limits side by side. SVG.
std::string ikTimePlot(std::span<const IkScore> scores);

// docs/ik.md: what was measured and how, what was aimed at, the plots (by the names of kIkPlotFiles, in `plotFolder`
// seen from the page) and ikScoreTable.
struct IkPlotFiles {
  const char* solved = "ik_solved.svg";
  const char* time = "ik_time.svg";
};
inline constexpr IkPlotFiles kIkPlotFiles;
std::string ikPage(std::span<const IkScore> scores, const std::string& plotFolder);

}  // namespace limber
