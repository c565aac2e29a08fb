// A reading refined by the shape of the limbs.
#pragma once

#include <string_view>

#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

// Moves roles of people ("upright") and four-legged animals ("four") to where middles and cuts of limbs show their
// joints (refineHumanoid, refineQuadruped); fingers go along with their hand. What the shape shows farther from the
// reading than its expected errors is something else, and is left out. Known roles stay, other plans are as they were.
void refineRoles(std::string_view plan, const BodyVolume& body, RoleReading& reading);

}  // namespace limber
