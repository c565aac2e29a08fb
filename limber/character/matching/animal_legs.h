// The legs of those that do not move as people do, as far as both skeletons have them.
#pragma once

#include <optional>
#include <vector>

#include "limber/character/matching/neutral_pose.h"

namespace limber {

// Joints of one side of the map.
struct LegJoints {
  Index upper = 0, lower = 0, end = 0;  // hip or shoulder; the joint that bends the leg most; where it rests
  std::optional<Index> toes;            // the next joint after the end
  std::optional<Index> hock;            // of those between, the one that bends it most after `lower`
  std::optional<Index> carrier;         // of an end on a root of its own: the joint of the leg that it rides on
};

struct AnimalLeg {
  LegJoints source, target;
  bool fore = false;  // of two pairs the foremost
  // Its foot follows the source's, whatever the joint angles: on roots of their own, on legs whose joints are others,
  // or where there are but two to stand on.
  bool footDriven = false;
};

// Of the matched joints of those that are no people, in rest pose.
struct BodySize {
  double height = 0;  // over the lowest, mean
  double across = 0;
  double spread = 0;  // mean distance from their middle, along the ground: tips of wings count little
  // Else it lies flat, as a snake does.
  bool isStanding() const;
};
BodySize bodySize(const SkeletonMap& map, MapSide side, const NeutralPose& neutral);

// Matched legs with hip, knee and foot, left before right, the foremost first. None where a body lies flat, or has more
// than two pairs of them.
std::vector<AnimalLeg> animalLegs(const SkeletonMap& map, const Skeleton& source, const Skeleton& target,
                                  const NeutralPose& sourceNeutral, const NeutralPose& targetNeutral);

}  // namespace limber
