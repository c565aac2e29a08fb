// The joints of a skeleton where a reading has them.
#pragma once

#include <vector>

#include "limber/rigging/roles/body_kinds.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

// Joints with a role are at its position, pinned ones where they are pinned (and are placed from then on), the others
// lie between as in the skeleton's rest pose; tips are where samples say that the last bone of a limb ends. A skeleton
// without any role keeps its own positions, as high as the model.
//
// pins  #J
// Returns #J, body space.
std::vector<Vec3> placedJoints(RoledSkeleton& made, const RoleReading& reading, const TemplatePins& pins);

}  // namespace limber
