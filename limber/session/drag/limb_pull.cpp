#include "limber/session/drag/limb_pull.h"

#include <algorithm>

#include "limber/skeleton/chain.h"

namespace limber {

std::optional<Index> limbBase(const Skeleton& skeleton, Index joint) {
  const std::vector<std::vector<Index>> children = childrenOf(skeleton);
  const auto parentOf = [&](Index j) { return skeleton.joints[j].parent; };
  const std::optional<Index> first = parentOf(joint);
  if (!first || !parentOf(*first)) return std::nullopt;
  Index base = *first;
  while (children[base].size() == 1) {
    const std::optional<Index> above = parentOf(base);
    if (!parentOf(*above) || children[*above].size() > 1) break;
    base = *above;
  }
  return base;
}

LimbPull::LimbPull(const Skeleton& skeleton, std::span<const PinnedTarget> targets, const JointLimits* limits,
                   std::string_view solver)
    : skeleton_(skeleton), limits_(limits) {
  for (std::size_t t = 0; t < targets.size(); ++t) {
    IkTarget wanted;
    wanted.joint = targets[t].joint;
    wanted.position = targets[t].position;
    wanted.base = limbBase(skeleton, targets[t].joint);
    if (!wanted.base) continue;
    used_.push_back(t);
    wanted_.push_back(wanted);
  }
  if (wanted_.empty()) return;
  IkOptions options;
  options.rootMotion = RootMotion::kFixed;
  options.restarts = 0;  // another attempt might find another pose than the frame before
  solver_.emplace(findIkMethod(solver), skeleton, wanted_, limits, options);
}

void LimbPull::solve(Pose& pose, std::span<const PinnedTarget> targets) {
  if (!solver_) return;
  for (std::size_t t = 0; t < used_.size(); ++t) wanted_[t].position = targets[used_[t]].position;
  solver_->solve(pose, wanted_);
  for (const std::size_t t : used_) {
    if (targets[t].rotation) turnTo(pose, targets[t].joint, *targets[t].rotation);
  }
}

void LimbPull::turnTo(Pose& pose, Index joint, const Quat& rotation) const {
  const Index parent = *skeleton_.joints[joint].parent;  // a joint with a limb has one
  Quat& local = pose.locals[joint].rotation;
  local = (decompose(poseGlobals(skeleton_, pose)[parent]).rotation.conjugate() * rotation).normalized();
  if (limits_) local = nearestAllowed(limits_->joints[joint], local);
}

void setTarget(std::vector<PinnedTarget>& targets, const PinnedTarget& target) {
  for (PinnedTarget& known : targets) {
    if (known.joint == target.joint) {
      known = target;
      return;
    }
  }
  targets.push_back(target);
}

void eraseTarget(std::vector<PinnedTarget>& targets, Index joint) {
  targets.erase(std::remove_if(targets.begin(), targets.end(), [&](const PinnedTarget& t) { return t.joint == joint; }),
                targets.end());
}

}  // namespace limber
