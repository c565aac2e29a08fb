// Children and ancestors of a skeleton's joints.
#pragma once

#include <optional>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// #J children of each joint, in index order.
std::vector<std::vector<Index>> childrenOf(const Skeleton& skeleton);

// Whether `above` is `joint` or one of its ancestors.
bool isAncestorOrSelf(const Skeleton& skeleton, Index above, Index joint);

// The last joint without a parent on the path up from `joint`.
Index rootOf(const Skeleton& skeleton, Index joint);

// The nearest joint above one of which that holds, if any.
std::optional<Index> nearestAbove(const Skeleton& skeleton, Index joint, const auto& holds) {
  std::optional<Index> at = skeleton.joints[joint].parent;
  while (at && !holds(*at)) at = skeleton.joints[*at].parent;
  return at;
}

}  // namespace limber
