// The kinds of bodies, and the skeleton that each gets.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limber/rigging/roles/joint_roles.h"
#include "limber/rigging/roles/role_reading.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

struct BodyKind {
  std::string_view name;     // "fish"
  std::string_view summary;  // one line for --help
  std::string_view plan;     // of ReadingWeights::plans
  // Pairs of arms and legs that it has at least and at most, whatever is read.
  std::size_t minPairs = 0, maxPairs = 5;
};

// The first one of a plan is the usual one.
std::span<const BodyKind> bodyKinds();
// Throws Error kBadArgument that lists the names there are.
const BodyKind& findBodyKind(std::string_view name);

// A skeleton, and the roles by which its joints are positioned.
struct RoledSkeleton {
  TemplateSkeleton skeleton;
  std::vector<std::optional<RolePosition>> roles;  // #J; of tips the role of the joint above
};

// The kind's skeleton for a body: the template of its name. Where there is none, joints depend on the body: as many
// legs (within the kind's limits, the likeliest pairs), fins and joints of a tail as it has. Joints of all these are named by one rule: hips, spine, chest, neck, head
// and tail along the trunk; per side UpperLeg, LowerLeg, Foot and Toes of one pair of legs, with Front and Hind before
// them of two, with numbers behind them of more (from the front: none, 1, 2, ...); UpperArm or UpperWing and what is
// below; Fin.
RoledSkeleton skeletonOfKind(const BodyKind& kind, const RoleReading& reading);

}  // namespace limber
