// Commands that change a joint from how it is, for tests of sessions. Not installed.
#pragma once

#include <string>

#include "limber/session/command.h"

namespace limber::testing {

// About the joint's own origin, `axis` in the world.
inline SetTurn turnedBy(const std::string& joint, const Vec3& axis, double degrees) {
  return {.joint = joint, .turn = degrees * axis.normalized(), .relative = true};
}
inline PlaceJoint movedBy(const std::string& joint, const Vec3& offset) {
  return {.joint = joint, .position = offset, .relative = true};
}

}  // namespace limber::testing
