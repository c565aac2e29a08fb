// How many legs a body has, as the ends of its limbs tell.
#pragma once

#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

// The ends of limbs whose nearest sample is a part of a leg or an arm.
//
// body  of the reading's model
// Cost: that of limbTips.
std::size_t countLegs(const BodyVolume& body, const RoleReading& reading);

}  // namespace limber
