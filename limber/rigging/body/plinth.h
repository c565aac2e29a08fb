// The slab that a statue rests on.
#pragma once

#include <optional>

#include "limber/rigging/body/body_volume.h"

namespace limber {

// How high along `up` (a unit vector) the plinth under a body ends, in the mesh's space: a slab at the bottom, about as
// wide as all of the body, above which the body takes far less room. None where there is no such slab.
// Cost: all nodes of the distance's grid, twice.
std::optional<double> plinthTop(const BodyVolume& body, const Vec3& up);

}  // namespace limber
