// Every inverse kinematics method over the same problems: how many it solves, how long it takes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/progress.h"
#include "limber/report/table.h"
#include "limber/skeleton/ik/ik_problem.h"
#include "limber/skeleton/ik/limits/limits.h"
#include "limber/skeleton/pose.h"

namespace limber {

enum class IkReach {
  kReachable,    // where another allowed pose has the effectors
  kBorderline,   // free chains: at 97 to 99.9 % of their length; with limits: where joints stand at their bounds
  kUnreachable,  // further than the bones are long
};

// One start pose and its targets.
struct IkProblem {
  Pose start;
  std::vector<IkTarget> targets;
};

// Problems of one kind for one skeleton.
struct IkProblemSet {
  std::string name;  // "chain-10 reachable", "humanoid reachable limits"
  IkReach reach = IkReach::kReachable;
  bool limited = false;
  double tolerance = 0;  // of IkOptions; 0: what the evaluation is asked for
  bool follows = false;  // each problem starts from the answer to the one before, as while dragging
  Skeleton skeleton;
  JointLimits limits;  // all free where not limited
  std::vector<IkProblem> problems;
};

// Chains of 3, 10, 30 and 100 joints and a humanoid of 60 joints with hands, feet and head as effectors; reachable,
// borderline (chains and the limited humanoid) and unreachable; free and with limits (chains: hinges and cones in turn;
// humanoid: humanoidLimits). Besides, the chain of 10 to a millionth of its length, and the humanoid's effectors on
// circles, frame by frame. `count` problems each, the same for the same seed.
std::vector<IkProblemSet> ikProblemSets(Index count, std::uint64_t seed);

// Where the analytic two-bone solution is measured by itself, without a solver round it.
inline constexpr std::string_view kClosedFormSet = "limb alone";

// What one method did on one set.
struct IkScore {
  std::string method, set;
  IkReach reach = IkReach::kReachable;
  bool limited = false;
  Index problems = 0;
  Index solved = 0;  // every target reached; of unreachable ones: every target that is not, named as out of reach
  double iterations = 0, restarts = 0;              // means
  double medianMicros = 0, percentile99Micros = 0;  // of one solve, set up and warm
  double worstViolation = 0;                        // of any limit in any answer, radians

  double fraction() const { return problems == 0 ? 0 : static_cast<double>(solved) / problems; }
};

struct IkEvaluationOptions {
  Index problems = 200;  // in each set
  std::uint64_t seed = 1;
  IkOptions ik;                      // tolerance: 1e-3 by default here
  std::vector<std::string> methods;  // none: all

  IkEvaluationOptions() { ik.tolerance = 1e-3; }
};

// Runs each method on each set that it can solve (two-bone: chains of 3, and kClosedFormSet). Throws Error kBadArgument
// for a method that is not known.
std::vector<IkScore> evaluateIk(const IkEvaluationOptions& options, Progress& progress);

// The method that solves the most of what is reachable or borderline with limits; the faster one where they tie.
std::string_view bestIkMethodWithLimits(std::span<const IkScore> scores);

// What one method did on the set of that name; null where it was not run.
const IkScore* findIkScore(std::span<const IkScore> scores, std::string_view method, std::string_view set);

// A line for each score, with that method named below.
Table ikScoreTable(std::span<const IkScore> scores);
Json toJson(std::span<const IkScore> scores);

}  // namespace limber
