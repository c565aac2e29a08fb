// The one rotation that turns several directions nearest to where they shall point.
#pragma once

#include "limber/core/types.h"

namespace limber {

// The rotation R that maximises the trace of R^T * correlation, where correlation is the sum of
// weight * wanted * current^T (Wahba 1965; Kabsch 1976). Of equally good ones (a single direction, or opposite ones) it
// takes one with little turning; the identity where the correlation is 0.
Quat bestRotation(const Mat3& correlation);

// The angle about the unit vector `axis` that does so among turns about that axis; 0 where all directions lie within
// about half a degree of the axis.
double bestAngle(const Mat3& correlation, const Vec3& axis);

}  // namespace limber
