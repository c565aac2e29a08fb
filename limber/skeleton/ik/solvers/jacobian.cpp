#include "limber/skeleton/ik/solvers/jacobian.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_task_rows.h"

namespace limber {

namespace {

// A slide as long as this fraction of the longest limb costs a step as much as a radian.
constexpr double kSlideFraction = 0.3;

}  // namespace

IkJacobian::IkJacobian(const IkSystem& system, std::vector<double> gains) : gains_(std::move(gains)) {
  Eigen::Index rows = 0;
  if (const IkTaskRows* tasks = system.tasks()) {
    levelBegin.assign(tasks->levelBegin().begin(), tasks->levelBegin().end());
    rows = levelBegin.back();
  }
  std::vector<std::size_t> order(system.effectors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return system.effectors[a].level < system.effectors[b].level; });
  rowBegin.resize(order.size());
  rowCount.resize(order.size());
  for (const std::size_t e : order) {
    const auto level = static_cast<std::size_t>(system.effectors[e].level);
    if (levelBegin.size() <= level) levelBegin.push_back(rows);
    rowBegin[e] = rows;
    rowCount[e] = system.oriented(e) ? 6 : 3;
    rows += rowCount[e];
  }
  if (!system.tasks()) levelBegin.push_back(rows);
  std::size_t columns = 0;
  for (const IkSystem::Node& node : system.nodes) columns += node.slides ? 6 : 3;
  matrix.resize(rows, static_cast<Eigen::Index>(columns));
  freedoms.reserve(columns);
  nodeBegin.resize(system.nodes.size() + 1);
}

void IkJacobian::addColumn(const IkSystem& system, int node, bool slides, const Vec3& axis, const Vec3& globalAxis) {
  matrix.col(columns()).setZero();
  const double gain = gains_[static_cast<std::size_t>(node)] * (slides ? slideLength_ : 1);
  if (const IkTaskRows* tasks = system.tasks()) {
    for (Eigen::Index r = 0; r < rows(); ++r) {
      matrix(r, columns()) = gain * tasks->slope(system, r, node, globalAxis, slides);
    }
  }
  const Vec3& pivot = system.positions[static_cast<std::size_t>(node)];
  for (const int below : system.effectorsBelow(node)) {
    const auto e = static_cast<std::size_t>(below);
    const IkSystem::Effector& effector = system.effectors[e];
    const double scale = gain * std::sqrt(effector.weight);
    const Vec3 arm = system.positions[static_cast<std::size_t>(effector.node)] - pivot;
    matrix.block<3, 1>(rowBegin[e], columns()) = scale * (slides ? globalAxis : Vec3(globalAxis.cross(arm)));
    if (rowCount[e] == 6 && !slides) {
      matrix.block<3, 1>(rowBegin[e] + 3, columns()) = scale * effector.angleScale * globalAxis;
    }
  }
  freedoms.push_back({node, slides, axis});
}

void IkJacobian::build(const IkSystem& system) {
  double reach = 0;
  for (const IkSystem::Effector& effector : system.effectors) reach = std::max(reach, effector.reach);
  if (IkTaskRows* tasks = system.tasks()) {
    tasks->measure(system, true);
    reach = tasks->size();
  }
  slideLength_ = reach > 0 ? kSlideFraction * reach : 1;
  freedoms.clear();
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const IkSystem::Node& node = system.nodes[i];
    nodeBegin[i] = static_cast<int>(freedoms.size());
    if (gains_[i] == 0) continue;
    TurnAxes axes;
    if (node.limit) {
      axes = turnAxes(*node.limit, system.locals[i]);
    } else {
      axes.axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
      axes.count = 3;
    }
    for (int k = 0; k < axes.count; ++k) {
      const Vec3& axis = axes.axes[static_cast<std::size_t>(k)];
      addColumn(system, n, false, axis, system.globals[i] * axis);
    }
    if (!node.slides) continue;
    const PlaneJoint* plane = node.limit ? std::get_if<PlaneJoint>(&node.limit->motion) : nullptr;
    const Quat frame = plane ? node.limit->neutral * node.limit->axes : Quat::Identity();
    const Quat parent = system.parentRotation(n);
    for (int k = 0; k < 3; ++k) {
      if (plane && k == 1) continue;
      const Vec3 axis = frame * Vec3(Vec3::Unit(k));
      addColumn(system, n, true, axis, parent * axis);
    }
  }
  nodeBegin.back() = static_cast<int>(freedoms.size());
}

void IkJacobian::residual(const IkSystem& system, Eigen::VectorXd& error) const {
  if (const IkTaskRows* tasks = system.tasks()) {
    for (Eigen::Index r = 0; r < rows(); ++r) error[r] = tasks->residual(r);
  }
  for (std::size_t e = 0; e < system.effectors.size(); ++e) {
    const IkSystem::Effector& effector = system.effectors[e];
    const auto node = static_cast<std::size_t>(effector.node);
    const double scale = std::sqrt(effector.weight);
    error.segment<3>(rowBegin[e]) = scale * (effector.target - system.positions[node]);
    if (rowCount[e] == 6) {
      const Vec3 turn = toRotationVector(effector.orientation * system.globals[node].conjugate());
      error.segment<3>(rowBegin[e] + 3) = scale * effector.angleScale * turn;
    }
  }
}

Vec3 IkJacobian::turnOf(int node, const Eigen::VectorXd& step) const {
  const auto n = static_cast<std::size_t>(node);
  Vec3 sum = Vec3::Zero();
  for (int c = nodeBegin[n]; c < nodeBegin[n + 1]; ++c) {
    const Freedom& freedom = freedoms[static_cast<std::size_t>(c)];
    if (!freedom.slides) sum += step[c] * freedom.axis;
  }
  return gains_[n] * sum;
}

Vec3 IkJacobian::slideOf(int node, const Eigen::VectorXd& step) const {
  const auto n = static_cast<std::size_t>(node);
  Vec3 sum = Vec3::Zero();
  for (int c = nodeBegin[n]; c < nodeBegin[n + 1]; ++c) {
    const Freedom& freedom = freedoms[static_cast<std::size_t>(c)];
    if (freedom.slides) sum += step[c] * freedom.axis;
  }
  return gains_[n] * slideLength_ * sum;
}

}  // namespace limber
