// The tree of a skeleton's joints, made once for all who ask how joints hang on each other.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/core/grouped.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// Joints keep their numbers. A parent may come behind its child, as where a foot of an inverse kinematics rig is joined
// to its shin (withLooseFeetJoined). Making it is linear in the joints; so is its memory.
class JointTree {
 public:
  explicit JointTree(const Skeleton& skeleton);
  // Throws Error kBadData naming the joint where parents form a cycle or do not exist.
  explicit JointTree(std::vector<std::optional<Index>> parents);

  Index size() const { return static_cast<Index>(parents_.size()); }
  const std::optional<Index>& parent(Index joint) const { return parents_[joint]; }
  std::span<const Index> children(Index joint) const { return children_.of(joint); }
  const std::vector<Index>& roots() const { return roots_; }
  // Every joint, parents before children; what hangs on a joint follows it without a gap.
  std::span<const Index> order() const { return order_; }
  // A joint and all that hangs on it.
  std::span<const Index> subtree(Index joint) const { return order().subspan(index_[joint], count_[joint]); }
  Index depth(Index joint) const { return depth_[joint]; }

  // O(1).
  bool isAboveOrSelf(Index above, Index joint) const { return index_[joint] - index_[above] < count_[above]; }
  // The lowest joint that both hang on or are; none where they have different roots. O(depth between).
  std::optional<Index> meeting(Index one, Index other) const;
  // The joints below `above` down to `joint`, `joint` included; empty where it is `above` or does not hang on it.
  std::vector<Index> pathBelow(Index above, Index joint) const;

 private:
  std::vector<std::optional<Index>> parents_;  // #J
  Grouped<Index> children_;                    // #J, in order of their numbers
  std::vector<Index> roots_;
  std::vector<Index> order_, index_;  // #J, preorder; index of each joint in it
  std::vector<Index> count_, depth_;  // #J, of the subtree; 0 of roots
};

// The skeleton's tree, but each of up to four feet that are roots or children of a root on the ground becomes a child
// of the shin above it, as in rigs for inverse kinematics, and two legs that are children of such a root beside the
// trunk become children of the trunk.
//
// positions  #J, along `up` in the body's pose
JointTree withLooseFeetJoined(const Skeleton& skeleton, std::span<const Vec3> positions, const Vec3& up);

}  // namespace limber
