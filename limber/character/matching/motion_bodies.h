// Motions of several bodies, as of two actors in one recording.
#pragma once

#include <string_view>
#include <vector>

#include "limber/skeleton/motion.h"

namespace limber {

// The root joints of whole bodies, in their order: with a trunk, a pair of legs, and a head, arms or more legs. Of
// skeletons whose hips move together, as a rig's controls and the joints that follow them do, the first. One root is
// not looked at. Cost: a reading of the anatomy for each of several roots.
std::vector<Index> bodyRoots(const Motion& motion);

// The motion of that joint, of all below it, and of its ancestors.
Motion motionBelow(const Motion& motion, Index root);

// The motion of one body. `body` names a joint of it, usually its root, or is its number among bodyRoots, from 1. With
// an empty name the whole motion as it is, where it holds one body at most. Throws Error kUnsupported that lists the
// bodies where it holds several and none is named, kBadArgument where no joint and no body is called so.
Motion motionOfBody(const Motion& motion, std::string_view body);

}  // namespace limber
