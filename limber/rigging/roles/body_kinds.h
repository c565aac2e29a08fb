// The kinds of bodies that get a skeleton of their own, and its joints.
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
};

// Those whose joints depend on the body: as many legs, fins and joints of a tail as it has. Joints of all are named by
// one rule: hips, spine, chest, neck, head and tail along the trunk; per side UpperLeg, LowerLeg, Foot and Toes of one
// pair of legs, with Front and Hind before them of two, with numbers behind them of more (from the front: none, 1, 2,
// ...); UpperArm or UpperWing and what is below; Fin.
std::span<const BodyKind> bodyKinds();
const BodyKind* findBodyKind(std::string_view name);  // null where there is none

// A skeleton, and which roles tell where its joints are.
struct RoledSkeleton {
  TemplateSkeleton skeleton;
  std::vector<std::optional<RolePosition>> roles;  // #J; of tips the role of the joint above
};

// The kind's skeleton for a body: with the limbs that it has.
RoledSkeleton skeletonOfKind(const BodyKind& kind, const RoleReading& reading);

// The part of the surface (ReadingWeights::parts) that the joint of a role moves.
std::string partOfRole(std::string_view role);

}  // namespace limber
