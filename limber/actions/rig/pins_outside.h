// Pins of joints that lie outside the model's surface.
#pragma once

#include <span>

#include "limber/core/error.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/rigging/auto_rigger.h"

namespace limber {

// Adds the warning "pins-outside", counted, where pins lie outside the surface by more than a hand is thick: the
// numbers are then of another pose or another model. It names the farthest and its distance in metres. Inside is where
// the winding number is above a half, whatever the surface's orientation.
//
// pins  in the source's space (mesh.frame)
void warnPinsOutside(const PreparedMesh& mesh, std::span<const JointPin> pins, Warnings& warnings);

}  // namespace limber
