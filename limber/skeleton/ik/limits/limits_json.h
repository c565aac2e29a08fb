// Joint limits as a JSON file; docs/limits.schema.json describes it.
#pragma once

#include <string>
#include <string_view>

#include "limber/skeleton/ik/limits/limits.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// {"limber_limits": 1, "joints": {"leftLowerLeg": {"type": "hinge", "x": [0, 135]}}}: by joint name; ranges in degrees
// (plane: metres), quaternions as [x, y, z, w]. "neutral" is the rest rotation where it is not given, "axes" the
// joint's own. Joints not named are free. Throws Error kBadData that names the entry: not JSON, another version, a
// joint that is not there, a type or key that is not known, ranges that make no sense.
JointLimits limitsFromJson(std::string_view text, const Skeleton& skeleton);

// The same file, of all joints that are not free; neutral and axes always given, so that it does not depend on the rest
// pose. Reading it back gives the limits to within rounding of degrees.
std::string limitsToJson(const JointLimits& limits, const Skeleton& skeleton);

}  // namespace limber
