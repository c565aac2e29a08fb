#include "limber/evaluate/motion/ik_evaluation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/random.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"
#include "limber/skeleton/ik/solvers/two_bone.h"

namespace limber {

namespace {

constexpr double kChainLength = 0.9;  // metres

class ProblemRandom : public Random {
 public:
  using Random::Random;

  Vec3 unitCube() {
    const double x = uniform(), y = uniform(), z = uniform();
    return Vec3(x, y, z);
  }
  Vec3 direction() {
    const double height = uniform(-1, 1), angle = uniform(0, 2 * kPi), ring = std::sqrt(1 - height * height);
    return Vec3(ring * std::cos(angle), height, ring * std::sin(angle));
  }
};

AngleRange degrees(double least, double most) {
  return {least * kPi / 180, most * kPi / 180};
}

// Hinges and cones in turn.
JointLimits chainLimits(const Skeleton& chain) {
  JointLimits limits;
  limits.joints.resize(chain.jointCount());
  for (Index j = 0; j < chain.jointCount(); ++j) {
    if (j % 2 == 1) {
      limits.joints[j].motion = Hinge{degrees(-10, 130)};
    } else {
      limits.joints[j].motion = BallAndSocket{degrees(-60, 90), degrees(-45, 45), degrees(-45, 45)};
    }
  }
  return limits;
}

// A pose that the limits allow; `edges`: with every joint at a bound of what its numbers say.
Pose allowedPose(const Skeleton& skeleton, const JointLimits& limits, bool edges, ProblemRandom& random) {
  Pose pose = restPose(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    Vec3 uniform = random.unitCube();
    if (edges) uniform.x() = uniform.x() < 0.5 ? 0 : 1;
    pose.locals[j].rotation = allowedRotation(limits.joints[j], uniform);
  }
  return pose;
}

// Near the rest pose, and not straight: every method may start there.
Pose startPose(const Skeleton& skeleton, const JointLimits& limits) {
  Pose pose = restPose(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Quat bent = pose.locals[j].rotation * fromRotationVector(Vec3(0.1, 0.02, 0.05));
    pose.locals[j].rotation = nearestAllowed(limits.joints[j], bent);
  }
  return pose;
}

void takeTargets(const Skeleton& skeleton, const Pose& pose, std::vector<IkTarget>& targets) {
  const std::vector<Affine> globals = poseGlobals(skeleton, pose);
  for (IkTarget& target : targets) target.position = globals[target.joint].translation();
}

IkProblem chainProblem(const IkProblemSet& set, ProblemRandom& random) {
  IkProblem problem;
  problem.start = startPose(set.skeleton, set.limits);
  problem.targets.resize(1);
  problem.targets[0].joint = set.skeleton.jointCount() - 1;
  if (set.reach == IkReach::kUnreachable) {
    problem.targets[0].position = kChainLength * random.uniform(1.05, 2) * random.direction();
  } else if (set.reach == IkReach::kBorderline && !set.limited) {
    problem.targets[0].position = kChainLength * random.uniform(0.97, 0.999) * random.direction();
  } else {
    const bool edges = set.reach == IkReach::kBorderline;
    takeTargets(set.skeleton, allowedPose(set.skeleton, set.limits, edges, random), problem.targets);
  }
  return problem;
}

// Poses midway from rest to a random one: people do not tie themselves in knots.
IkProblem humanoidProblem(const IkProblemSet& set, const JointLimits& anatomy, ProblemRandom& random) {
  IkProblem problem;
  problem.start = startPose(set.skeleton, set.limits);
  problem.targets = practiceHumanoidTargets(set.skeleton);
  const bool edges = set.reach == IkReach::kBorderline;
  Pose pose = allowedPose(set.skeleton, anatomy, edges, random);
  pose.locals[0].rotation = Quat::Identity().slerp(0.2, pose.locals[0].rotation);
  for (Index j = 1; j < set.skeleton.jointCount() && !edges; ++j) {
    const Quat rest = set.skeleton.joints[j].rest.rotation;
    pose.locals[j].rotation = nearestAllowed(anatomy.joints[j], rest.slerp(0.5, pose.locals[j].rotation));
  }
  takeTargets(set.skeleton, pose, problem.targets);
  if (set.reach == IkReach::kUnreachable) {
    for (IkTarget& target : problem.targets) target.position = Vec3(0, 1, 0) + 3 * (target.position - Vec3(0, 1, 0));
  }
  return problem;
}

// Hands, feet and head follow circles at walking pace, 60 frames a second.
IkProblem circleProblem(const IkProblemSet& set, double phase) {
  IkProblem problem;
  problem.start = startPose(set.skeleton, set.limits);
  problem.targets = practiceHumanoidTargets(set.skeleton);
  for (std::size_t t = 0; t < problem.targets.size(); ++t) {
    const double angle = phase + static_cast<double>(t);
    Vec3& position = problem.targets[t].position;
    position += 0.15 * (Vec3(0, 1, 0) - position) + 0.04 * Vec3(0, std::sin(angle), std::cos(angle));
  }
  return problem;
}

const char* nameOf(IkReach reach) {
  switch (reach) {
    case IkReach::kReachable:
      return "reachable";
    case IkReach::kBorderline:
      return "borderline";
    case IkReach::kUnreachable:
      return "unreachable";
  }
  return "";
}

IkProblemSet emptySet(const std::string& skeletonName, const Skeleton& skeleton, const JointLimits& limits,
                      IkReach reach, bool limited) {
  IkProblemSet set;
  set.name = fmt::format("{} {}{}", skeletonName, nameOf(reach), limited ? " limits" : "");
  set.reach = reach;
  set.limited = limited;
  set.skeleton = skeleton;
  set.limits = limits;
  if (!limited) set.limits.joints.assign(skeleton.jointCount(), JointLimit{});
  return set;
}

// What one solve is judged by.
bool isSolved(const IkProblemSet& set, const IkResult& result) {
  if (set.reach != IkReach::kUnreachable) return result.reached();
  return std::all_of(result.targets.begin(), result.targets.end(),
                     [](const IkTargetResult& target) { return target.outcome != IkOutcome::kStuck; });
}

void takeTimes(std::vector<double>& times, IkScore& score) {
  std::sort(times.begin(), times.end());
  score.medianMicros = times[times.size() / 2];
  score.percentile99Micros = times[std::min(times.size() - 1, times.size() * 99 / 100)];
}

IkScore scoreMethod(const IkMethod& method, const IkProblemSet& set, IkOptions options) {
  if (set.tolerance > 0) options.tolerance = set.tolerance;
  if (set.follows) options.restarts = 0;
  IkScore score;
  score.method = method.name;
  score.set = set.name;
  score.reach = set.reach;
  score.limited = set.limited;
  const JointLimits* limits = set.limited ? &set.limits : nullptr;
  IkSolver solver(method, set.skeleton, set.problems[0].targets, limits, options);
  Pose warmUp = set.problems[0].start;
  solver.solve(warmUp, set.problems[0].targets);
  std::vector<double> times;
  Pose pose = warmUp;
  for (const IkProblem& problem : set.problems) {
    if (!set.follows) pose = problem.start;
    const double begin = secondsNow();
    const IkResult& result = solver.solve(pose, problem.targets);
    times.push_back(1e6 * (secondsNow() - begin));
    ++score.problems;
    score.solved += isSolved(set, result) ? 1 : 0;
    score.iterations += result.iterations;
    score.restarts += result.restarts;
    for (Index j = 0; limits && j < set.skeleton.jointCount(); ++j) {
      score.worstViolation = std::max(score.worstViolation, limitViolation(limits->joints[j], pose.locals[j].rotation));
    }
  }
  score.iterations /= score.problems;
  score.restarts /= score.problems;
  takeTimes(times, score);
  return score;
}

// The analytic solution of one limb by itself, without a skeleton around it. Each problem is timed over many solves,
// since the clock takes as long as one.
IkScore scoreClosedForm(const IkEvaluationOptions& options) {
  constexpr int kRepeats = 100;
  ProblemRandom random(options.seed);
  IkScore score;
  score.method = "two-bone";
  score.set = kClosedFormSet;
  score.iterations = 1;
  TwoBone limb{Vec3::Zero(), Vec3(0.45, 0.02, 0), Vec3(kChainLength, 0, 0.03), Vec3::Zero(), {}};
  std::vector<double> times;
  for (Index i = 0; i < options.problems; ++i) {
    limb.target = kChainLength * random.uniform(0.1, 0.99) * random.direction();
    TwoBoneTurns turns;
    const double begin = secondsNow();
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      turns = solveTwoBone(limb);
      limb.target += 1e-12 * turns.start.vec();  // so that no solve can be left out
    }
    times.push_back(1e6 * (secondsNow() - begin) / kRepeats);
    const Vec3 end = turns.start * (limb.middle - limb.start) + turns.middle * (limb.end - limb.middle);
    ++score.problems;
    score.solved += (end - limb.target).norm() <= options.ik.tolerance * kChainLength ? 1 : 0;
  }
  takeTimes(times, score);
  return score;
}

}  // namespace

std::vector<IkProblemSet> ikProblemSets(Index count, std::uint64_t seed) {
  ProblemRandom random(seed);
  std::vector<IkProblemSet> sets;
  constexpr IkReach kReaches[] = {IkReach::kReachable, IkReach::kBorderline, IkReach::kUnreachable};
  for (const Index joints : {3u, 10u, 30u, 100u}) {
    const Skeleton chain = straightChain(joints, kChainLength);
    for (const bool limited : {false, true}) {
      for (const IkReach reach : kReaches) {
        IkProblemSet& set =
            sets.emplace_back(emptySet(fmt::format("chain-{}", joints), chain, chainLimits(chain), reach, limited));
        for (Index i = 0; i < count; ++i) set.problems.push_back(chainProblem(set, random));
      }
    }
  }
  const Skeleton humanoid = practiceHumanoid();
  const JointLimits anatomy = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
  for (const bool limited : {false, true}) {
    for (const IkReach reach : kReaches) {
      if (reach == IkReach::kBorderline && !limited) continue;
      IkProblemSet& set = sets.emplace_back(emptySet("humanoid", humanoid, anatomy, reach, limited));
      for (Index i = 0; i < count; ++i) set.problems.push_back(humanoidProblem(set, anatomy, random));
    }
  }
  IkProblemSet& exact =
      sets.emplace_back(emptySet("chain-10", straightChain(10, kChainLength), {}, IkReach::kReachable, false));
  exact.name = "chain-10 millionth";
  exact.tolerance = 1e-6;
  for (Index i = 0; i < count; ++i) exact.problems.push_back(chainProblem(exact, random));
  IkProblemSet& frames = sets.emplace_back(emptySet("humanoid", humanoid, {}, IkReach::kReachable, false));
  frames.name = "humanoid frames";
  frames.follows = true;
  const double phase = random.uniform(0, 2 * kPi);
  for (Index i = 0; i < count; ++i) frames.problems.push_back(circleProblem(frames, phase + 2 * kPi * i / 60));
  return sets;
}

std::vector<IkScore> evaluateIk(const IkEvaluationOptions& options, Progress& progress) {
  std::vector<const IkMethod*> methods;
  for (const std::string& name : options.methods) methods.push_back(&findIkMethod(name));
  if (methods.empty()) {
    for (const IkMethod& method : ikMethods()) methods.push_back(&method);
  }
  std::vector<IkScore> scores;
  if (options.problems == 0) return scores;
  progress.stage("inverse kinematics");
  const std::vector<IkProblemSet> sets = ikProblemSets(options.problems, options.seed);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (const IkMethod* method : methods) {
      progress.update(static_cast<double>(s) / static_cast<double>(sets.size()));
      if (method->name == "two-bone" && sets[s].skeleton.jointCount() != 3) continue;
      scores.push_back(scoreMethod(*method, sets[s], options.ik));
    }
  }
  const auto isTwoBone = [](const IkMethod* method) { return method->name == "two-bone"; };
  if (std::any_of(methods.begin(), methods.end(), isTwoBone)) scores.push_back(scoreClosedForm(options));
  progress.finish();
  return scores;
}

std::string_view bestIkMethodWithLimits(std::span<const IkScore> scores) {
  struct Sum {
    Index problems = 0, solved = 0;
    double micros = 0;
  };
  std::map<std::string_view, Sum> sums;
  Index most = 0;
  for (const IkScore& score : scores) {
    if (!score.limited || score.reach == IkReach::kUnreachable) continue;
    Sum& sum = sums[score.method];
    sum.problems += score.problems;
    sum.solved += score.solved;
    sum.micros += score.medianMicros;
    most = std::max(most, sum.problems);
  }
  std::string_view best;
  for (const auto& [method, sum] : sums) {
    if (sum.problems != most) continue;  // a method that cannot solve every set does not compete
    const Sum& leader = sums[best.empty() ? method : best];
    if (best.empty() || sum.solved > leader.solved || (sum.solved == leader.solved && sum.micros < leader.micros)) {
      best = method;
    }
  }
  return best;
}

const IkScore* findIkScore(std::span<const IkScore> scores, std::string_view method, std::string_view set) {
  for (const IkScore& score : scores) {
    if (score.method == method && score.set == set) return &score;
  }
  return nullptr;
}

Table ikScoreTable(std::span<const IkScore> scores) {
  Table table{{words("problems"), words("method"), number("solved", 1, " %"), number("iterations", 1),
               number("restarts", 2), number("median \u00b5s", 1), number("99 % \u00b5s", 1)}};
  for (const IkScore& score : scores) {
    table.add({score.set, score.method, 100 * score.fraction(), score.iterations, score.restarts, score.medianMicros,
               score.percentile99Micros});
  }
  const std::string_view best = bestIkMethodWithLimits(scores);
  if (!best.empty()) table.note = fmt::format("Best with limits: {}", best);
  return table;
}

Json toJson(std::span<const IkScore> scores) {
  Json list = Json::array();
  for (const IkScore& s : scores) {
    list.push_back({{"problems", s.set},
                    {"method", s.method},
                    {"count", s.problems},
                    {"solved", s.solved},
                    {"iterations", s.iterations},
                    {"restarts", s.restarts},
                    {"median_microseconds", s.medianMicros},
                    {"percentile_99_microseconds", s.percentile99Micros},
                    {"worst_violation", s.worstViolation}});
  }
  return {{"scores", std::move(list)}, {"best_with_limits", bestIkMethodWithLimits(scores)}};
}

}  // namespace limber
