#include "limber/character/anatomy/joint_tree.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

std::vector<std::optional<Index>> parentsOf(const Skeleton& skeleton) {
  std::vector<std::optional<Index>> parents;
  parents.reserve(skeleton.joints.size());
  for (const Joint& joint : skeleton.joints) parents.push_back(joint.parent);
  return parents;
}

}  // namespace

JointTree::JointTree(const Skeleton& skeleton) : JointTree(parentsOf(skeleton)) {}

JointTree::JointTree(std::vector<std::optional<Index>> parents) : parents_(std::move(parents)) {
  const Index joints = size();
  for (Index j = 0; j < joints; ++j) {
    const std::optional<Index>& parent = parents_[j];
    if (!parent) {
      roots_.push_back(j);
    } else if (*parent >= joints) {
      throw Error(ErrorCode::kBadData, fmt::format("joint {} hangs on joint {}, which is not there", j, *parent));
    }
  }
  children_ = Grouped<Index>(joints, [&](const auto& visit) {
    for (Index j = 0; j < joints; ++j) {
      if (parents_[j]) visit(*parents_[j], j);
    }
  });

  index_.assign(joints, 0);
  count_.assign(joints, 1);
  depth_.assign(joints, 0);
  order_.reserve(joints);
  std::vector<Index> open(roots_.rbegin(), roots_.rend());
  while (!open.empty()) {
    const Index joint = open.back();
    open.pop_back();
    index_[joint] = static_cast<Index>(order_.size());
    order_.push_back(joint);
    if (parents_[joint]) depth_[joint] = depth_[*parents_[joint]] + 1;
    const std::span<const Index> below = children(joint);
    open.insert(open.end(), below.rbegin(), below.rend());
  }
  if (order_.size() < joints) {
    std::vector<bool> reached(joints, false);
    for (const Index joint : order_) reached[joint] = true;
    const auto lost = std::find(reached.begin(), reached.end(), false) - reached.begin();
    throw Error(ErrorCode::kBadData, fmt::format("joint {} hangs on itself in a cycle", lost));
  }
  for (auto joint = order_.rbegin(); joint != order_.rend(); ++joint) {
    if (parents_[*joint]) count_[*parents_[*joint]] += count_[*joint];
  }
}

std::optional<Index> JointTree::meeting(Index one, Index other) const {
  std::optional<Index> up = one;
  while (up && !isAboveOrSelf(*up, other)) up = parents_[*up];
  return up;
}

std::vector<Index> JointTree::pathBelow(Index above, Index joint) const {
  std::vector<Index> path;
  if (!isAboveOrSelf(above, joint)) return path;
  for (Index j = joint; j != above; j = *parents_[j]) path.push_back(j);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace limber
