// Which joints of a reading (ReadingWeights::roles) give the positions of a skeleton's joints.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// A position on the straight line from the joint of one role to that of another.
struct RolePosition {
  std::string from, to;  // the same for a joint that is that of a role
  double fraction = 0;   // 0 at `from`, 1 at `to`

  bool isRole() const { return from == to; }
};
RolePosition atRole(std::string_view role);

// "fore_upper.L", of ReadingWeights::roles or parts. All but the limb may be empty.
struct RoleName {
  std::string_view limb, segment, side;  // "fore", "upper", ".L"
};
RoleName splitName(std::string_view name);

// The part of the surface (ReadingWeights::parts) that the joint of a role moves.
std::string partOfRole(std::string_view role);

// By the anatomy's parts: landmarks of legs and arms are roles; joints of the trunk, of tails and wings lie along the
// roles of theirs as far as along their chain at rest; further joints of limbs and necks lie between those around them.
//
// anatomy  of the skeleton
// Returns #J; none for joints without a role: props, hair, a face, what is beyond a limb's last role.
std::vector<std::optional<RolePosition>> jointRoles(const Skeleton& skeleton, const Anatomy& anatomy);

}  // namespace limber
