// Inverse kinematics under a user's finger: limbs that follow a joint, and pinned joints.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

inline constexpr std::string_view kLimbSolver = "whole-body";

struct PinnedTarget {
  Index joint = 0;
  Vec3 position = Vec3::Zero();
  std::optional<Quat> rotation = std::nullopt;  // global, of a joint that must not tilt either: a foot on the ground
};

// One for each joint: replaces the joint's previous one.
void setTarget(std::vector<PinnedTarget>& targets, const PinnedTarget& target);
void eraseTarget(std::vector<PinnedTarget>& targets, Index joint);

// The highest joint that turns when `joint` is pulled: the limb goes up to the joint below the next branch, and at
// least one joint up. None where there is nothing to turn: at a root, and right below one, which stays where it is.
std::optional<Index> limbBase(const Skeleton& skeleton, Index joint);

// Several joints pulled at once, each by its limb. Set up once, then solved frame after frame.
class LimbPull {
 public:
  // Joints without a limb are passed over. `skeleton` and `limits` (none: null) must outlive it. Throws Error
  // kBadArgument for a `solver` that is none of ikMethods(), or that refuses these limbs.
  LimbPull(const Skeleton& skeleton, std::span<const PinnedTarget> targets, const JointLimits* limits,
           std::string_view solver = kLimbSolver);

  // Whether any joint has a limb to turn.
  bool any() const { return solver_.has_value(); }
  // `targets` are those of the constructor, at other positions. `pose` is the start and becomes the result; the same
  // start and targets give the same result. A joint with a target rotation is rotated there once its limb has reached.
  // Throws Error as IkSystem::load does.
  void solve(Pose& pose, std::span<const PinnedTarget> targets);

 private:
  void turnTo(Pose& pose, Index joint, const Quat& rotation) const;

  const Skeleton& skeleton_;
  const JointLimits* limits_;
  std::vector<std::size_t> used_;  // of the targets given, those with a limb
  std::vector<IkTarget> wanted_;
  std::optional<IkSolver> solver_;
};

}  // namespace limber
