#include "limber/skeleton/chain.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

void checkJoint(const Skeleton& skeleton, Index joint) {
  if (joint >= skeleton.jointCount()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("joint {} of a skeleton of {}", joint, skeleton.jointCount()));
  }
}

std::vector<Index> pathToRoot(const Skeleton& skeleton, Index joint) {
  std::vector<Index> path = {joint};
  while (const std::optional<Index> parent = skeleton.joints[path.back()].parent) path.push_back(*parent);
  return path;
}

}  // namespace

std::vector<std::vector<Index>> childrenOf(const Skeleton& skeleton) {
  std::vector<std::vector<Index>> children(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (const std::optional<Index> parent = skeleton.joints[j].parent) children[*parent].push_back(j);
  }
  return children;
}

std::vector<JointChain> jointChains(const Skeleton& skeleton) {
  const std::vector<std::vector<Index>> children = childrenOf(skeleton);
  std::vector<JointChain> chains;
  std::vector<std::size_t> chainOf(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (parent && children[*parent].size() == 1) {
      chainOf[j] = chainOf[*parent];
    } else {
      chainOf[j] = chains.size();
      JointChain& chain = chains.emplace_back();
      if (parent) chain.above = chainOf[*parent];
    }
    chains[chainOf[j]].joints.push_back(j);
  }
  return chains;
}

std::vector<Index> limbBetween(const Skeleton& skeleton, Index from, Index to) {
  checkJoint(skeleton, from);
  checkJoint(skeleton, to);
  std::vector<Index> up = pathToRoot(skeleton, from);
  std::vector<Index> down = pathToRoot(skeleton, to);
  if (up.back() != down.back()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("no joint is above both '{}' and '{}'", skeleton.joints[from].name,
                                                     skeleton.joints[to].name));
  }
  while (up.size() > 1 && down.size() > 1 && up[up.size() - 2] == down[down.size() - 2]) {
    up.pop_back();
    down.pop_back();
  }
  up.insert(up.end(), down.rbegin() + 1, down.rend());
  return up;
}

bool isAncestorOrSelf(const Skeleton& skeleton, Index above, Index joint) {
  checkJoint(skeleton, above);
  checkJoint(skeleton, joint);
  while (joint > above) {  // parents come before children
    const std::optional<Index> parent = skeleton.joints[joint].parent;
    if (!parent) return false;
    joint = *parent;
  }
  return joint == above;
}

Index rootOf(const Skeleton& skeleton, Index joint) {
  checkJoint(skeleton, joint);
  while (const std::optional<Index> parent = skeleton.joints[joint].parent) joint = *parent;
  return joint;
}

}  // namespace limber
