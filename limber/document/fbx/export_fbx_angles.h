// Rotations as FBX has them: Euler angles.
#pragma once

#include "limber/core/types.h"

namespace limber {

// Degrees about x, y and z, turned in that order (FBX' eEulerXYZ: Rz * Ry * Rx), each within half a turn. Rounded to
// single precision, so that the same come out of any library's trigonometry.
Vec3 eulerDegrees(const Quat& rotation);

// Of all triples that mean the same rotation, the one closest to `before`: angles that do not jump.
Vec3 eulerDegreesNear(const Quat& rotation, const Vec3& before);

// The rotation of such angles.
Quat eulerRotation(const Vec3& degrees);

}  // namespace limber
