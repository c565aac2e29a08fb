#include "limber/skeleton/ik/ik_system.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/core/sort_unique.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/ik/ik_task_rows.h"

namespace limber {

namespace {

constexpr double kLaterPriority = 1e-6;  // weight of a priority against the one before
constexpr double kReachRounding = 1e-9;

[[noreturn]] void bad(const std::string& what, const std::string& where, ErrorCode code = ErrorCode::kBadArgument) {
  throw Error(code, what, where);
}

// The scale of a joint that moves others; solvers turn bones and cannot shear them.
double uniformScale(const Skeleton& skeleton, const Pose& pose, Index joint) {
  const Vec3& scale = pose.locals[joint].scale;
  const double spread = scale.maxCoeff() - scale.minCoeff();
  if (!(spread <= 1e-6 * scale.cwiseAbs().maxCoeff())) {
    bad("has a scale that differs between its axes, which inverse kinematics below it cannot keep",
        fmt::format("joint '{}'", skeleton.joints[joint].name), ErrorCode::kUnsupported);
  }
  return scale.x();
}

Quat unit(const Quat& q) {
  return std::abs(q.squaredNorm() - 1) <= 1e-15 ? q : q.normalized();
}

}  // namespace

IkSystem::IkSystem(const Skeleton& skeleton, std::span<const IkTarget> targets, const JointLimits* limits,
                   const IkOptions& options)
    : skeleton_(&skeleton), options_(options), shape_(targets.begin(), targets.end()) {
  if (targets.empty()) bad("inverse kinematics without a target", {});
  checkTargets(targets);
  setUp(targets, limits);
  addEffectors(targets);
  listEffectorsBelow();
  updateReach();
  mirror_ = IkMirror(*this);
  if (options_.reference) setReference(*options_.reference);
}

IkSystem::IkSystem(const Skeleton& skeleton, IkTaskRows& tasks, const JointLimits* limits, const IkOptions& options)
    : skeleton_(&skeleton), tasks_(&tasks), options_(options) {
  std::vector<IkTarget> moved;
  for (const Index joint : tasks.joints()) moved.emplace_back().joint = joint;
  if (moved.empty()) bad("inverse kinematics without a task", {});
  setUp(moved, limits);
  listEffectorsBelow();
  tasks.bind(*this);
  if (options_.reference) setReference(*options_.reference);
}

// Nodes for the joints above those that are moved, standing in rest pose.
void IkSystem::setUp(std::span<const IkTarget> moved, const JointLimits* limits) {
  const Index count = skeleton_->jointCount();
  if (limits && limits->joints.size() != count) {
    bad(fmt::format("{} limits for {} joints", limits->joints.size(), count), {});
  }
  if (options_.reference && options_.reference->locals.size() != count) {
    bad(fmt::format("a reference pose of {} joints for a skeleton of {}", options_.reference->locals.size(), count),
        {});
  }
  addNodes(*skeleton_, moved);
  for (Node& node : nodes) setUpNode(*skeleton_, limits, node);

  const std::size_t n = nodes.size();
  locals.resize(n, Quat::Identity());
  globals = baseRotations_ = references = locals;
  offsets.resize(n, Vec3::Zero());
  positions = basePositions_ = referenceOffsets = offsets;
  scales_.resize(n, 1.0);
  setReference(restPose(*skeleton_));
  forward();
}

void IkSystem::checkTargets(std::span<const IkTarget> targets) const {
  if (targets.size() != shape_.size()) {
    bad(fmt::format("{} targets for a solver made for {}", targets.size(), shape_.size()), {});
  }
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const IkTarget& target = targets[t];
    const auto refuse = [&](const std::string& what) { bad(what, fmt::format("target {}", t)); };
    if (target.joint >= skeleton_->jointCount())
      refuse(fmt::format("is for joint {}, which is not there", target.joint));
    if (target.base &&
        (*target.base >= skeleton_->jointCount() || !isAncestorOrSelf(*skeleton_, *target.base, target.joint))) {
      refuse("has a base that is not above its joint");
    }
    if (!target.position.allFinite()) refuse("has a position that is not finite");
    if (target.orientation && !(std::abs(target.orientation->norm() - 1) < 1e-3)) refuse("has a bad orientation");
    if (target.pole && !target.pole->allFinite()) refuse("has a pole that is not finite");
    if (!(target.weight > 0) || !std::isfinite(target.weight)) refuse("has a weight that is not positive");
    const IkTarget& made = shape_[t];
    if (target.joint != made.joint || target.base != made.base || target.priority != made.priority ||
        target.orientation.has_value() != made.orientation.has_value()) {
      refuse("is not for the joint, base, priority and kind that the solver was made for");
    }
  }
}

// The joints between effectors and bases, and between a base and the next node above it, if there is one: those do not
// move themselves.
void IkSystem::addNodes(const Skeleton& skeleton, std::span<const IkTarget> targets) {
  std::vector<char> kind(skeleton.jointCount(), 0);  // 0: none, 1: carried only, 2: moves
  for (const IkTarget& target : targets) {
    const Index base = target.base.value_or(rootOf(skeleton, target.joint));
    for (Index j = target.joint;; j = *skeleton.joints[j].parent) {
      kind[j] = 2;
      if (j == base) break;
    }
  }
  for (Index j = skeleton.jointCount(); j-- > 0;) {
    if (kind[j] != 2) continue;
    Index above = j;
    while (skeleton.joints[above].parent) {
      above = *skeleton.joints[above].parent;
      if (kind[above] != 0) break;
    }
    if (kind[above] == 0) continue;
    for (Index k = j; k != above; k = *skeleton.joints[k].parent) kind[k] = std::max(kind[k], char{1});
  }
  nodeOf_.assign(skeleton.jointCount(), -1);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (kind[j] == 0) continue;
    Node node;
    node.joint = j;
    node.freedom = kind[j] == 2 ? 1 : 0;
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (parent) node.parent = nodeOf_[*parent];
    nodeOf_[j] = nodeCount();
    nodes.push_back(node);
    if (node.parent >= 0) {
      Node& above = nodes[static_cast<std::size_t>(node.parent)];
      above.onlyChild = ++above.childCount == 1 ? nodeOf_[j] : -1;
    }
  }
}

void IkSystem::setUpNode(const Skeleton& skeleton, const JointLimits* limits, Node& node) {
  const bool isRoot = !skeleton.joints[node.joint].parent;
  if (isRoot && options_.rootMotion == RootMotion::kFixed) node.freedom = 0;
  if (isRoot && options_.rootMotion == RootMotion::kTranslate && node.freedom > 0) node.slides = true;
  if (!limits) return;
  const JointLimit& limit = limits->joints[node.joint];
  checkLimit(limit, fmt::format("limit of joint '{}'", skeleton.joints[node.joint].name));
  node.freedom *= 1 - limit.stiffness;
  if (!std::holds_alternative<FreeJoint>(limit.motion)) node.limit = &limit;
  if (std::holds_alternative<PlaneJoint>(limit.motion) && node.freedom > 0) node.slides = true;
  if (node.limit || node.freedom < 1) limited_ = true;
}

void IkSystem::addEffectors(std::span<const IkTarget> targets) {
  std::vector<int> levels;
  for (const IkTarget& target : targets) levels.push_back(target.priority);
  sortUnique(levels);
  for (const IkTarget& target : targets) {
    Effector& effector = effectors.emplace_back();
    effector.node = nodeOf_[target.joint];
    effector.level = static_cast<int>(std::lower_bound(levels.begin(), levels.end(), target.priority) - levels.begin());
    for (int n = effector.node; n >= 0; n = nodes[static_cast<std::size_t>(n)].parent) effector.path.push_back(n);
    std::reverse(effector.path.begin(), effector.path.end());
  }
}

void IkSystem::listEffectorsBelow() {
  std::vector<std::vector<int>> below(nodes.size());
  for (std::size_t e = 0; e < effectors.size(); ++e) {
    for (const int n : effectors[e].path) below[static_cast<std::size_t>(n)].push_back(static_cast<int>(e));
  }
  belowBegin_.push_back(0);
  for (const std::vector<int>& list : below) {
    below_.insert(below_.end(), list.begin(), list.end());
    belowBegin_.push_back(static_cast<int>(below_.size()));
  }
}

std::span<const int> IkSystem::effectorsBelow(int node) const {
  const auto n = static_cast<std::size_t>(node);
  return {below_.data() + belowBegin_[n], static_cast<std::size_t>(belowBegin_[n + 1] - belowBegin_[n])};
}

void IkSystem::setReference(const Pose& reference) {
  loadFrames(reference);
  references = locals;
  referenceOffsets = offsets;
}

void IkSystem::loadFrames(const Pose& pose) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Node& node = nodes[n];
    const Transform& local = pose.locals[node.joint];
    if (node.parent >= 0) {
      const auto p = static_cast<std::size_t>(node.parent);
      scales_[n] = scales_[p] * uniformScale(*skeleton_, pose, nodes[p].joint);
    } else {
      Quat rotation = Quat::Identity();
      Vec3 position = Vec3::Zero();
      double scale = 1;
      std::optional<Index> above = skeleton_->joints[node.joint].parent;
      while (above) {
        const Transform& frame = pose.locals[*above];
        const double s = uniformScale(*skeleton_, pose, *above);
        const Quat turn = unit(frame.rotation);
        position = frame.translation + turn * Vec3(s * position);
        rotation = turn * rotation;
        scale *= s;
        above = skeleton_->joints[*above].parent;
      }
      baseRotations_[n] = rotation;
      basePositions_[n] = position;
      scales_[n] = scale;
    }
    locals[n] = unit(local.rotation);
    offsets[n] = scales_[n] * local.translation;
  }
}

void IkSystem::load(const Pose& pose, std::span<const IkTarget> targets) {
  if (pose.locals.size() != skeleton_->jointCount()) {
    bad(fmt::format("a pose of {} joints for a skeleton of {}", pose.locals.size(), skeleton_->jointCount()), {});
  }
  checkTargets(targets);
  symmetric_ = false;
  loadFrames(pose);
  if (limited_) {
    for (int n = 0; n < nodeCount(); ++n) limitNode(n);
  }
  forward();
  updateReach();
  for (std::size_t e = 0; e < effectors.size(); ++e) {
    Effector& effector = effectors[e];
    effector.target = targets[e].position;
    effector.pole = targets[e].pole;
    effector.weight = targets[e].weight * (effector.level == 0 ? 1 : std::pow(kLaterPriority, effector.level));
    effector.angleScale = 0;
    if (targets[e].orientation) {
      effector.orientation = targets[e].orientation->normalized();
      // An effector that is its own base has no length; a radian then counts as a metre.
      effector.angleScale = effector.reach > 0 ? options_.angleWeight * effector.reach : 1;
    }
  }
  symmetric_ = !tasks_ && mirror_.fits(*this);
}

void IkSystem::updateReach() {
  for (Effector& effector : effectors) {
    effector.reach = 0;
    for (std::size_t i = 1; i < effector.path.size(); ++i) {
      effector.reach += offsets[static_cast<std::size_t>(effector.path[i])].norm();
    }
  }
}

void IkSystem::store(Pose& pose) const {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Transform& local = pose.locals[nodes[n].joint];
    local.rotation = locals[n];
    if (nodes[n].slides && scales_[n] != 0) local.translation = offsets[n] / scales_[n];
  }
}

void IkSystem::forwardFrom(int first) {
  for (int i = first; i < nodeCount(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Quat parent = parentRotation(i);
    globals[n] = parent * locals[n];
    positions[n] = parentPosition(i) + parent * offsets[n];
  }
}

Vec3 IkSystem::parentPosition(int node) const {
  const auto n = static_cast<std::size_t>(node);
  return nodes[n].parent < 0 ? basePositions_[n] : positions[static_cast<std::size_t>(nodes[n].parent)];
}

Quat IkSystem::parentRotation(int node) const {
  const auto n = static_cast<std::size_t>(node);
  return nodes[n].parent < 0 ? baseRotations_[n] : globals[static_cast<std::size_t>(nodes[n].parent)];
}

void IkSystem::limitNode(int node) {
  const auto n = static_cast<std::size_t>(node);
  const JointLimit* limit = nodes[n].limit;
  if (!limit) return;
  locals[n] = nearestAllowed(*limit, locals[n]);
  if (nodes[n].slides && scales_[n] != 0 && std::holds_alternative<PlaneJoint>(limit->motion)) {
    offsets[n] = scales_[n] * nearestAllowedTranslation(*limit, offsets[n] / scales_[n]);
  }
}

double IkSystem::distance(std::size_t effector) const {
  const Effector& e = effectors[effector];
  return (e.target - positions[static_cast<std::size_t>(e.node)]).norm();
}

double IkSystem::angle(std::size_t effector) const {
  const Effector& e = effectors[effector];
  return e.angleScale > 0 ? angleBetween(globals[static_cast<std::size_t>(e.node)], e.orientation) : 0;
}

bool IkSystem::reached(std::size_t effector) const {
  const Effector& e = effectors[effector];
  const double tolerance = options_.tolerance * e.reach;
  return distance(effector) <= std::max(tolerance, kReachRounding * e.reach) &&
         angle(effector) <= options_.angleTolerance;
}

bool IkSystem::allReached() const {
  if (tasks_) return tasks_->met(*this);
  for (std::size_t e = 0; e < effectors.size(); ++e) {
    if (!reached(e)) return false;
  }
  return true;
}

double IkSystem::cost() const {
  if (tasks_) return tasks_->cost(*this);
  double sum = 0;
  for (std::size_t e = 0; e < effectors.size(); ++e) {
    const Effector& effector = effectors[e];
    const Vec3 gap = effector.target - positions[static_cast<std::size_t>(effector.node)];
    const double turn = effector.angleScale > 0 ? effector.angleScale * angle(e) : 0;
    sum += effector.weight * (gap.squaredNorm() + turn * turn);
  }
  return sum;
}

bool IkSystem::outOfReach(std::size_t effector) const {
  const Effector& e = effectors[effector];
  double longest = 0;
  for (std::size_t i = 0; i < e.path.size(); ++i) {
    const auto n = static_cast<std::size_t>(e.path[i]);
    if (nodes[n].slides) return false;
    if (i > 0) longest = std::max(longest, offsets[n].norm());
  }
  const double gap = (e.target - positions[static_cast<std::size_t>(e.path.front())]).norm();
  const double slack = options_.tolerance * e.reach;
  return gap > e.reach + slack || gap < 2 * longest - e.reach - slack;
}

void IkSystem::save(State& state) const {
  std::copy(locals.begin(), locals.end(), state.locals.begin());
  std::copy(offsets.begin(), offsets.end(), state.offsets.begin());
}

void IkSystem::restore(const State& state) {
  std::copy(state.locals.begin(), state.locals.end(), locals.begin());
  std::copy(state.offsets.begin(), state.offsets.end(), offsets.begin());
  forward();
}

}  // namespace limber
