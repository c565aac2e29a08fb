// A pose as a thing of its own: with the skeleton that it was taken from, so that any other one can be put into it.
#pragma once

#include <optional>
#include <string>

#include "limber/skeleton/pose.h"

namespace limber {

struct PortablePose {
  std::string name;  // for display, may be empty
  Skeleton skeleton;
  Pose pose;
};

// The pose on `to` where that is the same skeleton: joints are found by name, have the parent of that name, and rest as
// there but for what a file rounds off. Joints that the pose does not know stand at rest, as long as they are the
// fewer. Locals are those of the pose, bit for bit. Nothing for another skeleton.
std::optional<Pose> poseByNames(const PortablePose& pose, const Skeleton& to);

}  // namespace limber
