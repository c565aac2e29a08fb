// Where the heads and feet of a BVH's body are, which tell which axis points up.
#pragma once

#include <span>
#include <vector>

#include "limber/document/bvh/bvh_hierarchy.h"

namespace limber {

struct BvhEnds {
  std::vector<Index> heads;  // or another joint at the upper end of the trunk
  std::vector<Index> feet;

  bool known() const { return !heads.empty() && !feet.empty(); }
  // From the middle of the feet to the middle of the heads, of #J positions. Both must be known.
  Vec3 upwards(std::span<const Vec3> positions) const;
};

// By names: heads have "head" in theirs, feet "foot", "toe" or "ankle".
BvhEnds namedEnds(std::span<const BvhJoint> joints);

// By the tree alone, whatever its joints are called and however they rest. Legs and arms are pairs of long chains of
// equal lengths, each pair attached to one joint: the legs' joint is the one next to the root along the bones, the
// arms' joint is the one farthest from it, which represents the head. Unknown where there are no two such pairs, or the
// legs are shorter than the arms: the root of such a tree may lie at its upper end.
BvhEnds endsOfTree(std::span<const BvhJoint> joints);

// By names, and by the tree where these do not tell both ends.
BvhEnds findEnds(std::span<const BvhJoint> joints);

// #J positions in the rest pose, lengths and axes of the file.
std::vector<Vec3> restPositionsOf(std::span<const BvhJoint> joints);

}  // namespace limber
