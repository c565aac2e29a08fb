// Retargeting methods against each other: every motion on every character, as a table.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/evaluate/motion/motion_metrics.h"
#include "limber/evaluate/motion/retarget_judge.h"
#include "limber/report/table.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct RetargetScore {
  std::string motion, character, method;
  MotionMetrics metrics;
  double framesPerSecond = 0;              // of the method, on one thread
  bool heldOut = false;                    // no constant is set by it (held_out.h)
  std::optional<double> inside;            // mean fraction of the surface inside the body, of a character with a skin
  std::optional<RetargetVerdict> verdict;  // where RetargetTrial::judge
};

struct RetargetTrial {
  std::vector<std::filesystem::path> motions, characters;
  std::function<Motion(Motion)> prepare;  // what is done to a motion before it is used, if anything
  std::vector<std::string> methods;       // empty: all
  Index maxFrames = 1000;                 // of each clip; what comes later is left out
  bool judge = false;                     // with verdicts
  std::size_t insideFrames = 10;          // in which it is seen what of the surface is inside the body; 0: in none
};

// A score for each clip of each motion, on each character, by each method, in that order; clips of less than 5 frames
// and pairs without legs, or that cannot be matched, are counted in `skipped`.
std::vector<RetargetScore> scoreRetargeting(const RetargetTrial& trial, Progress& progress, Warnings& skipped);

// A line for each method: means over the scores, worst values in brackets.
Table retargetMethodTable(std::span<const RetargetScore> scores);
// A line for each score.
Table eachRetargetScore(std::span<const RetargetScore> scores);

}  // namespace limber
