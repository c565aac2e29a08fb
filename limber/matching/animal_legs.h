// The legs of those that are no people, as far as both skeletons have them: told by their form.
#pragma once

#include <optional>
#include <vector>

#include "limber/matching/neutral_pose.h"

namespace limber {

// Joints of one side of the map.
struct LegJoints {
  Index upper = 0, lower = 0, end = 0;  // `lower`: the joint between that bends the leg most
  std::optional<Index> toes;            // the next joint after the end
  std::optional<Index> hock;            // of those between, the one that bends it most after `lower`
  std::optional<Index> carrier;         // of an end on a root of its own: the shin that it rides on
};

struct AnimalLeg {
  LegJoints source, target;
};

// Of the matched joints of those that are no people, in rest pose.
struct BodySize {
  double height = 0;  // over the lowest, mean
  double across = 0;
  double spread = 0;  // mean distance from their middle, along the ground: tips of wings count little
  // Else it lies flat, as a snake does.
  bool stands() const;
};
BodySize bodySize(const SkeletonMap& map, MapSide side, const NeutralPose& neutral);

// Chains of matched joints, one on the other in both, that come down from the body to the ground in both neutral poses.
// Feet on a root of their own count as on the shin above them (parentsWithLegsJoined).
// The end is the first joint of the chain that is low. None where a body lies flat. Cost: linear in the joints but for
// their depth.
std::vector<AnimalLeg> animalLegs(const SkeletonMap& map, const Skeleton& source, const Skeleton& target,
                                  const NeutralPose& sourceNeutral, const NeutralPose& targetNeutral);

}  // namespace limber
