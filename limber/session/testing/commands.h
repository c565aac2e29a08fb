// Commands as tests of sessions give them. Not installed.
#pragma once

#include <string>

#include "limber/core/progress.h"
#include "limber/session/session.h"

namespace limber::testing {

inline void perform(Session& session, const Command& command) {
  Progress progress;
  session.run(command, progress);
}

// About the joint's own origin, `axis` in the world.
inline SetTurn turnedBy(const std::string& joint, const Vec3& axis, double degrees) {
  return {.joint = joint, .turn = degrees * axis.normalized(), .relative = true};
}
inline PlaceJoint movedBy(const std::string& joint, const Vec3& offset) {
  return {.joint = joint, .position = offset, .relative = true};
}

}  // namespace limber::testing
