#include "limber/skeleton/ik/ik_task_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "limber/core/rotation.h"
#include "limber/core/sort_unique.h"
#include "limber/skeleton/ik/support_polygon.h"

namespace limber {

namespace {

constexpr double kActivated = 1e-12;  // of the body's size: what a step must violate an inequality by
constexpr double kOpposite = 1e-6;    // of a look in the opposite direction, where no rotation is better than another

// Along Y.
Eigen::Vector2d flat(const Vec3& point) {
  return {point.x(), point.z()};
}

Mat3 crossMatrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// d log(R exp(w)) / dw at w = 0, where log(R) = turn.
Mat3 logDerivative(const Vec3& turn) {
  const double angle = turn.norm(), squared = angle * angle;
  const double factor = angle < 1e-4 ? 1.0 / 12 + squared / 720 : (1 - angle / 2 / std::tan(angle / 2)) / squared;
  const Mat3 cross = crossMatrix(turn);
  return Mat3::Identity() + 0.5 * cross + factor * cross * cross;
}

Vec3 anyPerpendicular(const Vec3& v) {
  Eigen::Index smallest = 0;
  v.cwiseAbs().minCoeff(&smallest);
  return v.cross(Vec3(Vec3::Unit(smallest))).normalized();
}

Eigen::Index rowsOf(const IkTaskGoal& goal) {
  if (const auto* balance = std::get_if<BalanceTask>(&goal)) return balance->centred ? 2 : 1;
  return std::holds_alternative<DistanceTask>(goal) || std::holds_alternative<PlaneTask>(goal) ||
                 std::holds_alternative<KeepOutTask>(goal)
             ? 1
             : 3;
}

bool isInequality(const IkTaskGoal& goal) {
  if (const auto* plane = std::get_if<PlaneTask>(&goal)) return plane->above;
  if (const auto* balance = std::get_if<BalanceTask>(&goal)) return !balance->centred;
  return std::holds_alternative<KeepOutTask>(goal);
}

bool isAngle(const IkTaskGoal& goal) {
  return std::holds_alternative<OrientationTask>(goal) || std::holds_alternative<LookAtTask>(goal) ||
         std::holds_alternative<CouplingTask>(goal);
}

// Rods as heavy as bones are long, half of each at either end.
std::vector<PointMass> massesOfBones(const Skeleton& skeleton) {
  const std::vector<Vec3> positions = posePositions(skeleton, restPose(skeleton));
  std::vector<PointMass> masses;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    masses.push_back({j, Vec3::Zero(), 0});
    if (!skeleton.joints[j].parent) continue;
    const double length = (positions[j] - positions[*skeleton.joints[j].parent]).norm();
    masses[j].mass += length / 2;
    masses[*skeleton.joints[j].parent].mass += length / 2;
  }
  std::erase_if(masses, [](const PointMass& mass) { return !(mass.mass > 0); });
  if (masses.empty()) masses.push_back({0, Vec3::Zero(), 1});
  return masses;
}

}  // namespace

// The errors of one task, into rows from `first` on.
class IkTaskRows::Measure {
 public:
  Measure(IkTaskRows& rows, const IkSystem& system, std::size_t first, bool slopes)
      : rows_(rows), system_(system), first_(first), slopes_(slopes) {}

  void operator()(const PositionTask& task) const {
    setPoint(task.target - position(task.joint));
    for (std::size_t k = 0; k < 3; ++k) push(k, task.joint, Vec3::Unit(static_cast<Eigen::Index>(k)));
  }

  void operator()(const OrientationTask& task) const {
    const Vec3 turn = toRotationVector((task.target * rotation(task.joint).conjugate()).normalized());
    setPoint(rows_.angleScale_ * turn);
    if (!slopes_) return;
    const Mat3 slope = rows_.angleScale_ * logDerivative(turn);
    for (std::size_t k = 0; k < 3; ++k) twist(k, task.joint, slope.row(static_cast<Eigen::Index>(k)).transpose());
  }

  void operator()(const LookAtTask& task) const {
    const Vec3 look = rotation(task.joint) * task.axis, line = task.target - position(task.joint);
    const double distance = line.norm();
    const Vec3 wanted = distance > 0 ? Vec3(line / distance) : look;
    Vec3 gap = wanted - look;
    if ((wanted + look).norm() < kOpposite) gap += anyPerpendicular(look);
    setPoint(rows_.angleScale_ * gap);
    if (!slopes_) return;
    const Mat3 across = Mat3::Identity() - wanted * wanted.transpose();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 unit = Vec3::Unit(static_cast<Eigen::Index>(k));
      twist(k, task.joint, rows_.angleScale_ * look.cross(unit));
      if (distance > 0) push(k, task.joint, rows_.angleScale_ / distance * (across * unit));
    }
  }

  void operator()(const DistanceTask& task) const {
    const Index* other = std::get_if<Index>(&task.from);
    const Vec3 line = position(task.joint) - (other ? position(*other) : std::get<Vec3>(task.from));
    const double distance = line.norm();
    const Vec3 direction = distance > 0 ? Vec3(line / distance) : Vec3(Vec3::UnitY());
    set(0, task.distance - distance);
    push(0, task.joint, direction);
    if (other) push(0, *other, -direction);
  }

  void operator()(const PlaneTask& task) const {
    set(0, task.offset - task.normal.dot(position(task.joint)));
    push(0, task.joint, task.normal);
  }

  void operator()(const BalanceTask& task) const {
    Vec3 center = Vec3::Zero();
    for (const PointMass& mass : rows_.masses_) center += mass.mass / rows_.totalMass_ * massPoint(mass);
    if (task.centred) {
      Vec3 mean = Vec3::Zero();
      const double weight = 1 / static_cast<double>(task.supports.size());
      for (const Index support : task.supports) mean += weight * position(support);
      for (std::size_t k = 0; k < 2; ++k) {
        const Vec3 axis = k == 0 ? Vec3::UnitX() : Vec3::UnitZ();
        set(k, axis.dot(mean - center));
        pushMasses(k, axis);
        for (const Index support : task.supports) push(k, support, -weight * axis);
      }
      return;
    }
    std::vector<Eigen::Vector2d> corners;
    for (const Index support : task.supports) corners.push_back(flat(position(support)));
    const HullPoint onHull = nearestOnHull(flat(center), corners);
    const Vec3 out(onHull.out.x(), 0, onHull.out.y());
    set(0, onHull.distance);
    pushMasses(0, -out);
    push(0, task.supports[onHull.a], (1 - onHull.weight) * out);
    push(0, task.supports[onHull.b], onHull.weight * out);
  }

  void operator()(const KeepOutTask& task) const {
    const Vec3 here = position(task.joint);
    const Vec3 nearest = task.from + nearestOnSegment(here, task.from, task.to) * (task.to - task.from);
    const Vec3 line = here - nearest;
    const double distance = line.norm();
    const Vec3 along = task.to - task.from;
    const Vec3 out = distance > 0              ? Vec3(line / distance)
                     : along.squaredNorm() > 0 ? anyPerpendicular(along)
                                               : Vec3(Vec3::UnitY());
    set(0, task.radius - distance);
    push(0, task.joint, out);
  }

  void operator()(const CouplingTask& task) const {
    const auto [leader, leaderTurn] = turnFromRest(task.leader);
    const auto [follower, followerTurn] = turnFromRest(task.joint);
    const Quat leaderRest = rows_.restRotations_[leader], followerRest = rows_.restRotations_[follower];
    const double scale = rows_.angleScale_;
    setPoint(scale * (task.ratio * (leaderRest * leaderTurn) - followerRest * followerTurn));
    if (!slopes_) return;
    const Mat3 follows = scale * followerRest.toRotationMatrix() * logDerivative(followerTurn);
    const Mat3 leads = -scale * task.ratio * leaderRest.toRotationMatrix() * logDerivative(leaderTurn);
    for (std::size_t k = 0; k < 3; ++k) {
      twistAgainstParent(k, follower, follows.row(static_cast<Eigen::Index>(k)).transpose());
      twistAgainstParent(k, leader, leads.row(static_cast<Eigen::Index>(k)).transpose());
    }
  }

 private:
  std::size_t node(Index joint) const { return static_cast<std::size_t>(system_.nodeOf(joint)); }
  const Vec3& position(Index joint) const { return system_.positions[node(joint)]; }
  const Quat& rotation(Index joint) const { return system_.globals[node(joint)]; }
  Vec3 massPoint(const PointMass& mass) const { return position(mass.joint) + rotation(mass.joint) * mass.offset; }
  std::pair<std::size_t, Vec3> turnFromRest(Index joint) const {
    const std::size_t n = node(joint);
    return {n, toRotationVector((rows_.restLocals_[n].conjugate() * system_.locals[n]).normalized())};
  }

  void set(std::size_t row, double error) const { rows_.rows_[first_ + row].error = error; }
  void setPoint(const Vec3& error) const {
    for (std::size_t k = 0; k < 3; ++k) set(k, error[static_cast<Eigen::Index>(k)]);
  }

  // Minus the derivative of the row's error by where a point of the node is, and by how the node is turned.
  void push(std::size_t row, Index joint, const Vec3& force) const { pushAt(row, joint, position(joint), force); }
  void pushAt(std::size_t row, Index joint, const Vec3& point, const Vec3& force) const {
    if (!slopes_) return;
    rows_.forces_[slot(row, node(joint))] += force;
    rows_.moments_[slot(row, node(joint))] += point.cross(force);
  }
  void twist(std::size_t row, Index joint, const Vec3& torque) const {
    rows_.moments_[slot(row, node(joint))] += torque;
  }
  // By how the node is turned in its parent, in its own frame.
  void twistAgainstParent(std::size_t row, std::size_t n, const Vec3& torque) const {
    const Vec3 global = system_.globals[n] * torque;
    rows_.moments_[slot(row, n)] += global;
    const int parent = system_.nodes[n].parent;
    if (parent >= 0) rows_.moments_[slot(row, static_cast<std::size_t>(parent))] -= global;
  }
  void pushMasses(std::size_t row, const Vec3& force) const {
    for (const PointMass& mass : rows_.masses_) {
      pushAt(row, mass.joint, massPoint(mass), mass.mass / rows_.totalMass_ * force);
    }
  }
  std::size_t slot(std::size_t row, std::size_t n) const { return (first_ + row) * system_.nodes.size() + n; }

  IkTaskRows& rows_;
  const IkSystem& system_;
  std::size_t first_;
  bool slopes_;
};

IkTaskRows::IkTaskRows(const Skeleton& skeleton, std::span<const IkTask> tasks, const IkTaskOptions& options)
    : tasks_(tasks.begin(), tasks.end()), options_(options.ik), masses_(options.masses) {
  if (masses_.empty()) masses_ = massesOfBones(skeleton);
  for (const PointMass& mass : masses_) totalMass_ += mass.mass;
  std::vector<int> priorities;
  for (const IkTask& task : tasks_) priorities.push_back(task.priority);
  sortUnique(priorities);
  rowBegin_.resize(tasks_.size());
  rowCount_.resize(tasks_.size());
  levelOf_.resize(tasks_.size());
  levelBegin_.push_back(0);
  for (std::size_t level = 0; level < priorities.size(); ++level) {
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
      if (tasks_[t].priority != priorities[level]) continue;
      levelOf_[t] = level;
      rowBegin_[t] = static_cast<Eigen::Index>(rows_.size());
      rowCount_[t] = rowsOf(tasks_[t].goal);
      Row row;
      row.rootWeight = std::sqrt(tasks_[t].weight);
      row.inequality = isInequality(tasks_[t].goal);
      rows_.insert(rows_.end(), static_cast<std::size_t>(rowCount_[t]), row);
    }
    levelBegin_.push_back(static_cast<Eigen::Index>(rows_.size()));
  }
  caps_.assign(levels(), 0.0);
}

std::vector<Index> IkTaskRows::joints() const {
  std::vector<Index> joints;
  for (const IkTask& task : tasks_) {
    const auto add = [&](const auto& goal) {
      if constexpr (!std::is_same_v<std::decay_t<decltype(goal)>, BalanceTask>) joints.push_back(goal.joint);
    };
    std::visit(add, task.goal);
    if (const auto* distance = std::get_if<DistanceTask>(&task.goal)) {
      if (const Index* other = std::get_if<Index>(&distance->from)) joints.push_back(*other);
    } else if (const auto* coupling = std::get_if<CouplingTask>(&task.goal)) {
      joints.push_back(coupling->leader);
    } else if (const auto* balance = std::get_if<BalanceTask>(&task.goal)) {
      joints.insert(joints.end(), balance->supports.begin(), balance->supports.end());
      for (const PointMass& mass : masses_) joints.push_back(mass.joint);
    }
  }
  return joints;
}

void IkTaskRows::bind(const IkSystem& system) {
  restRotations_ = system.globals;
  restLocals_ = system.locals;
  const std::size_t count = system.nodes.size();
  std::vector<double> reach(count, 0.0);
  double longest = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (system.nodes[n].parent < 0) continue;
    reach[n] = reach[static_cast<std::size_t>(system.nodes[n].parent)] + system.offsets[n].norm();
    longest = std::max(longest, reach[n]);
  }
  size_ = longest > 0 ? longest : 1;
  angleScale_ = options_.angleWeight > 0 ? options_.angleWeight * size_ : size_;
  forces_.resize(rows_.size() * count);
  moments_.resize(rows_.size() * count);
}

void IkTaskRows::follow(IkSystem& system) const {
  for (const IkTask& task : tasks_) {
    const auto* coupling = std::get_if<CouplingTask>(&task.goal);
    if (!coupling) continue;
    const auto leader = static_cast<std::size_t>(system.nodeOf(coupling->leader));
    const auto follower = static_cast<std::size_t>(system.nodeOf(coupling->joint));
    if (system.nodes[follower].freedom == 0) continue;
    const Vec3 turn = toRotationVector((restLocals_[leader].conjugate() * system.locals[leader]).normalized());
    const Quat between = restRotations_[follower].conjugate() * restRotations_[leader];
    system.locals[follower] = restLocals_[follower] * fromRotationVector(coupling->ratio * (between * turn));
    system.limitNode(static_cast<int>(follower));
    system.forward();
  }
}

void IkTaskRows::measure(const IkSystem& system, bool slopes) {
  if (slopes) {
    std::fill(forces_.begin(), forces_.end(), Vec3::Zero());
    std::fill(moments_.begin(), moments_.end(), Vec3::Zero());
  }
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    std::visit(Measure(*this, system, static_cast<std::size_t>(rowBegin_[t]), slopes), tasks_[t].goal);
  }
  if (!slopes) return;
  const std::size_t count = system.nodes.size();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    rows_[r].errorWithSlopes = rows_[r].error;
    rows_[r].active = !rows_[r].inequality || rows_[r].pressed || rows_[r].error > 0;
    for (std::size_t n = count; n-- > 0;) {
      if (system.nodes[n].parent < 0) continue;
      const std::size_t from = r * count + n, to = r * count + static_cast<std::size_t>(system.nodes[n].parent);
      forces_[to] += forces_[from];
      moments_[to] += moments_[from];
    }
  }
}

double IkTaskRows::slope(const IkSystem& system, Eigen::Index row, int node, const Vec3& axis, bool slides) const {
  const auto r = static_cast<std::size_t>(row), n = static_cast<std::size_t>(node);
  const std::size_t slot = r * system.nodes.size() + n;
  const Vec3& force = forces_[slot];
  const Vec3 along = slides ? force : Vec3(moments_[slot] - system.positions[n].cross(force));
  return rows_[r].rootWeight * axis.dot(along);
}

double IkTaskRows::residual(Eigen::Index row) const {
  const Row& r = rows_[static_cast<std::size_t>(row)];
  return r.active ? r.rootWeight * r.errorWithSlopes : 0;
}

bool IkTaskRows::activate(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& step, Eigen::Index columns) {
  bool any = false;
  for (Eigen::Index r = 0; r < levelBegin_[served_]; ++r) {
    Row& row = rows_[static_cast<std::size_t>(r)];
    if (row.active) continue;
    double error = row.rootWeight * row.errorWithSlopes;
    for (Eigen::Index c = 0; c < columns; ++c) error -= step[c] * matrix(r, c);
    if (!(error > kActivated * size_ * row.rootWeight)) continue;
    row.active = any = true;
  }
  return any;
}

double IkTaskRows::errorOf(std::size_t task) const {
  double sum = 0;
  for (Eigen::Index k = 0; k < rowCount_[task]; ++k) {
    const Row& row = rows_[static_cast<std::size_t>(rowBegin_[task] + k)];
    const double error = row.inequality && !row.pressed ? std::max(row.error, 0.0) : row.error;
    sum += error * error;
  }
  return std::sqrt(sum);
}

double IkTaskRows::toleranceOf(std::size_t task) const {
  return isAngle(tasks_[task].goal) ? angleScale_ * options_.angleTolerance
                                    : size_ * std::max(options_.tolerance, 1e-9);
}

double IkTaskRows::levelCost(std::size_t level) const {
  double sum = 0;
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    if (levelOf_[t] == level) sum += tasks_[t].weight * errorOf(t) * errorOf(t);
  }
  return sum;
}

double IkTaskRows::slackOf(std::size_t level) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    if (levelOf_[t] == level) least = std::min(least, tasks_[t].weight * toleranceOf(t) * toleranceOf(t));
  }
  return least;
}

void IkTaskRows::serve(const IkSystem& system, std::size_t levels) {
  served_ = levels;
  measure(system, false);
  for (Row& row : rows_) row.wasViolated = row.inequality && row.error > 0;
  for (std::size_t level = 0; level + 1 < levels; ++level) {
    const double cost = levelCost(level), slack = slackOf(level);
    caps_[level] = cost <= slack ? slack : cost + slack;
  }
}

bool IkTaskRows::press(const IkSystem& system) {
  measure(system, false);
  bool any = false;
  for (Eigen::Index r = 0; r < levelBegin_[served_]; ++r) {
    Row& row = rows_[static_cast<std::size_t>(r)];
    row.pressed = row.wasViolated && row.error < -options_.tolerance * size_;
    any = any || row.pressed;
  }
  return any;
}

void IkTaskRows::release() {
  for (Row& row : rows_) row.pressed = false;
}

double IkTaskRows::cost(const IkSystem& system) {
  measure(system, false);
  for (std::size_t level = 0; level + 1 < served_; ++level) {
    if (!(levelCost(level) <= caps_[level])) return std::numeric_limits<double>::infinity();
  }
  return levelCost(served_ - 1);
}

bool IkTaskRows::met(const IkSystem& system) {
  measure(system, false);
  for (std::size_t t = 0; t < tasks_.size(); ++t) {
    if (levelOf_[t] + 1 == served_ && !(errorOf(t) <= toleranceOf(t))) return false;
  }
  return true;
}

IkTaskReport IkTaskRows::report(const IkSystem& system, std::size_t task) {
  measure(system, false);
  IkTaskReport report;
  report.isAngle = isAngle(tasks_[task].goal);
  report.met = errorOf(task) <= toleranceOf(task);
  report.residual = errorOf(task);
  if (report.isAngle) report.residual /= angleScale_;
  // A look's error is a chord.
  if (std::holds_alternative<LookAtTask>(tasks_[task].goal)) {
    report.residual = 2 * std::asin(std::min(report.residual / 2, 1.0));
  }
  return report;
}

}  // namespace limber
