// A skeleton's chains, and the limbs that run from one joint to another.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// A maximal run of joints without a branch: each but the last has exactly one child, the next. Root to tip.
struct JointChain {
  std::vector<Index> joints;         // at least one
  std::optional<std::size_t> above;  // the chain whose last joint is the parent of this one's first; none for a root
};

// Every joint is in exactly one chain; chains come in the order of their first joints, so `above` is always earlier.
std::vector<JointChain> jointChains(const Skeleton& skeleton);

// #J children of each joint, in index order.
std::vector<std::vector<Index>> childrenOf(const Skeleton& skeleton);

// The joints from `from` to `to`, both included: up to the nearest joint above both, then down. Throws Error
// kBadArgument where an index is not a joint or no joint is above both.
std::vector<Index> limbBetween(const Skeleton& skeleton, Index from, Index to);

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
