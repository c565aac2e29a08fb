// Skeletons whose joints are given, limber's and users', with the roles of their joints.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "limber/rigging/roles/body_kinds.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

// Joints with a role are placed, all others lie between.
//
// roles  of the skeleton's joints, where its last are tips without those; tips have the role of the joint above
RoledSkeleton withRoles(TemplateSkeleton skeleton, std::vector<std::optional<RolePosition>> roles);

// Of templateSkeletons(). Where the reading has raised heels, as animals on two legs have them, the feet of a person
// are there, and the toes where the legs come to the ground.
RoledSkeleton templateWithRoles(const TemplateSkeleton& skeleton, const RoleReading& reading);

// A user's skeleton, whatever its rest pose and orientation. Throws Error as templateFrom does.
RoledSkeleton ownWithRoles(const Skeleton& skeleton, std::string_view name);

}  // namespace limber
