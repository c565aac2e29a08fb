#include "limber/skeleton/ik/ik_task.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/ik/ik_task_rows.h"
#include "limber/skeleton/ik/solvers/whole_body.h"

namespace limber {

namespace {

constexpr double kNearby = 0.1;         // fraction of the rotation to a random one, for another attempt
constexpr double kClearlyBetter = 0.9;  // of the cost: what another posture is taken for

class TaskCheck {
 public:
  TaskCheck(const Skeleton& skeleton, std::size_t number) : skeleton_(skeleton), number_(number) {}

  void operator()(const PositionTask& task) const { joint(task.joint), finite(task.target); }
  void operator()(const OrientationTask& task) const {
    joint(task.joint);
    require(std::abs(task.target.norm() - 1) < 1e-6, "has an orientation that is not of length 1");
  }
  void operator()(const LookAtTask& task) const { joint(task.joint), finite(task.target), unit(task.axis); }
  void operator()(const DistanceTask& task) const {
    joint(task.joint);
    if (const Index* other = std::get_if<Index>(&task.from)) {
      joint(*other);
      require(*other != task.joint, "is of a joint from itself");
    } else {
      finite(std::get<Vec3>(task.from));
    }
    require(task.distance >= 0 && std::isfinite(task.distance), "has a distance below 0");
  }
  void operator()(const PlaneTask& task) const {
    joint(task.joint), unit(task.normal);
    require(std::isfinite(task.offset), "has an offset that is not finite");
  }
  void operator()(const BalanceTask& task) const {
    require(!task.supports.empty(), "has no supports");
    require(task.supports.size() <= kMaxSupports, fmt::format("has more than {} supports", kMaxSupports));
    for (const Index support : task.supports) joint(support);
  }
  void operator()(const KeepOutTask& task) const {
    joint(task.joint), finite(task.from), finite(task.to);
    require(task.radius > 0 && std::isfinite(task.radius), "has a radius that is not above 0");
  }
  void operator()(const CouplingTask& task) const {
    joint(task.joint), joint(task.leader);
    require(task.joint != task.leader, "couples a joint to itself");
    require(std::isfinite(task.ratio), "has a ratio that is not finite");
  }
  void require(bool holds, std::string_view what) const {
    if (!holds) throw Error(ErrorCode::kBadArgument, std::string(what), fmt::format("task {}", number_));
  }

 private:
  void joint(Index joint) const { require(joint < skeleton_.jointCount(), "is for a joint that is not there"); }
  void finite(const Vec3& point) const { require(point.allFinite(), "has a point that is not finite"); }
  void unit(const Vec3& axis) const { require(std::abs(axis.norm() - 1) < 1e-6, "has an axis not of length 1"); }

  const Skeleton& skeleton_;
  std::size_t number_;
};

// A whole solve: the tasks' rows on the joints that they move, and the iterations that serve them.
class TaskSolve {
 public:
  TaskSolve(const Skeleton& skeleton, const Pose& start, std::span<const IkTask> tasks, const JointLimits* limits,
            const IkTaskOptions& options)
      : rows_(skeleton, tasks, options), system_(skeleton, rows_, limits, options.ik), random_(options.ik.seed) {
    iteration_ = makeWholeBody(system_);
    system_.load(start, {});
    rows_.follow(system_);
    best_ = system_.makeState();
  }

  void run() {
    attempt();
    std::vector<double> least = costs();
    system_.save(best_);
    for (Index r = 0; r < system_.options().restarts && !served(least); ++r) {
      perturbNodes(system_, random_, kNearby);
      attempt();
      const std::vector<double> now = costs();
      if (isBetter(now, least)) {
        least = now;
        system_.save(best_);
      } else {
        system_.restore(best_);
      }
    }
  }

  IkTaskReport report(std::size_t task) { return rows_.report(system_, task); }
  void store(Pose& pose) const { system_.store(pose); }
  Index iterations() const { return iterations_; }
  IkSystem& system() { return system_; }

 private:
  void attempt() {
    for (std::size_t level = 1; level <= rows_.levels(); ++level) {
      rows_.serve(system_, level);
      iterations_ += iteration_->run(system_, system_.options().maxIterations);
      if (rows_.press(system_)) goBackToSurfaces();
    }
  }

  // Where that costs nothing.
  void goBackToSurfaces() {
    IkSystem::State out = system_.makeState();
    rows_.release();
    const double cost = system_.cost();
    rows_.press(system_);
    iterations_ += iteration_->run(system_, system_.options().maxIterations);
    rows_.release();
    const double slack = rows_.slackOf(rows_.servedLevels() - 1);
    if (!(system_.cost() <= std::max(cost, slack))) system_.restore(out);
  }

  std::vector<double> costs() {
    rows_.measure(system_, false);
    std::vector<double> costs;
    for (std::size_t level = 0; level < rows_.levels(); ++level) costs.push_back(rows_.levelCost(level));
    return costs;
  }
  bool served(const std::vector<double>& costs) const { return firstUnserved(costs) == costs.size(); }
  std::size_t firstUnserved(const std::vector<double>& costs) const {
    std::size_t level = 0;
    while (level < costs.size() && costs[level] <= rows_.slackOf(level)) ++level;
    return level;
  }
  // By the first priority in which they clearly differ.
  bool isBetter(const std::vector<double>& now, const std::vector<double>& before) const {
    for (std::size_t level = 0; level < now.size(); ++level) {
      const double slack = rows_.slackOf(level);
      if (now[level] <= slack && before[level] <= slack) continue;
      if (now[level] < kClearlyBetter * before[level]) return true;
      if (now[level] > before[level] + slack) return false;
    }
    return false;
  }

  IkTaskRows rows_;
  IkSystem system_;
  std::unique_ptr<IkIteration> iteration_;
  IkSystem::State best_;
  Random random_;
  Index iterations_ = 0;
};

// Further from the base, or from each other, than the bones between are long.
bool isTooFar(const IkTaskGoal& goal, const IkSystem& system) {
  const auto pathOf = [&](Index joint) {
    std::vector<int> path;
    for (int n = system.nodeOf(joint); n >= 0; n = system.nodes[static_cast<std::size_t>(n)].parent) path.push_back(n);
    return path;
  };
  const auto lengthOf = [&](const std::vector<int>& path, std::size_t count) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += system.offsets[static_cast<std::size_t>(path[i])].norm();
    return sum;
  };
  const auto isBeyond = [&](Index joint, const Vec3& point, double reach) {
    const std::vector<int> path = pathOf(joint);
    const auto base = static_cast<std::size_t>(path.back());
    if (system.nodes[base].slides) return false;
    return (point - system.positions[base]).norm() > lengthOf(path, path.size() - 1) + reach;
  };
  if (const auto* position = std::get_if<PositionTask>(&goal)) return isBeyond(position->joint, position->target, 0);
  const auto* distance = std::get_if<DistanceTask>(&goal);
  if (!distance) return false;
  if (const Vec3* point = std::get_if<Vec3>(&distance->from)) {
    return isBeyond(distance->joint, *point, distance->distance);
  }
  std::vector<int> a = pathOf(distance->joint), b = pathOf(std::get<Index>(distance->from));
  while (!a.empty() && !b.empty() && a.back() == b.back()) a.pop_back(), b.pop_back();
  return lengthOf(a, a.size()) + lengthOf(b, b.size()) < distance->distance;
}

IkTaskObstacle obstacleOf(const Skeleton& skeleton, const Pose& start, const IkTask& task, const JointLimits* limits,
                          const IkTaskOptions& options) {
  TaskSolve alone(skeleton, start, {&task, 1}, limits, options);
  if (isTooFar(task.goal, alone.system())) return IkTaskObstacle::kTooFar;
  alone.run();
  if (alone.report(0).met) return IkTaskObstacle::kOtherTasks;
  if (!limits) return IkTaskObstacle::kUnknown;
  TaskSolve free(skeleton, start, {&task, 1}, nullptr, options);
  free.run();
  return free.report(0).met ? IkTaskObstacle::kLimits : IkTaskObstacle::kUnknown;
}

}  // namespace

bool IkTaskResult::met() const {
  for (const IkTaskReport& task : tasks) {
    if (!task.met) return false;
  }
  return true;
}

IkTaskResult solveIkTasks(const Skeleton& skeleton, Pose& pose, std::span<const IkTask> tasks,
                          const JointLimits* limits, const IkTaskOptions& options) {
  if (tasks.size() > kMaxIkTasks) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} tasks are asked for at once", tasks.size()), {},
                fmt::format("at most {} can be", kMaxIkTasks));
  }
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const TaskCheck check(skeleton, t);
    std::visit(check, tasks[t].goal);
    check.require(tasks[t].weight > 0 && std::isfinite(tasks[t].weight), "has a weight that is not above 0");
  }
  for (const PointMass& mass : options.masses) {
    if (mass.joint < skeleton.jointCount() && mass.offset.allFinite() && mass.mass > 0 && std::isfinite(mass.mass)) {
      continue;
    }
    throw Error(ErrorCode::kBadArgument, "a mass for balance that is not above 0, or of a joint that is not there");
  }
  TaskSolve solve(skeleton, pose, tasks, limits, options);
  solve.run();
  IkTaskResult result;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    IkTaskReport& report = result.tasks.emplace_back(solve.report(t));
    if (!report.met) report.obstacle = obstacleOf(skeleton, pose, tasks[t], limits, options);
  }
  result.iterations = solve.iterations();
  solve.store(pose);
  return result;
}

}  // namespace limber
