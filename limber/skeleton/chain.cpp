#include "limber/skeleton/chain.h"

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

void checkJoint(const Skeleton& skeleton, Index joint) {
  if (joint >= skeleton.jointCount()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("joint {} of a skeleton of {}", joint, skeleton.jointCount()));
  }
}

}  // namespace

std::vector<std::vector<Index>> childrenOf(const Skeleton& skeleton) {
  std::vector<std::vector<Index>> children(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (const std::optional<Index> parent = skeleton.joints[j].parent) children[*parent].push_back(j);
  }
  return children;
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
