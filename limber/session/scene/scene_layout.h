// Where the members of a scene are: new ones beside those that are there, and attached ones at their joints.
#pragma once

#include <span>

#include "limber/session/scene/scene.h"

namespace limber {

// Throws Error kBadArgument where the rig has no joint of that name.
Affine jointFrame(const SessionState& state, const std::string& joint);

// The member's own space in that of the scene.
Affine toScene(std::span<const SceneMember> members, std::size_t member);

// Of the bound surface, in the space that `transform` brings it to.
Box boxOf(const Session& session, const Affine& transform);

// Beside the existing members, on the first one's ground.
Placement besideOthers(std::span<const SceneMember> members, const Session& added);

// Does the member, or one that carries it, follow a joint of `carrier`?
bool isCarriedBy(std::span<const SceneMember> members, std::size_t member, const Session* carrier);

// The same attachment after `from` has become `to`, the joint of that name with its offset where both are rest poses of
// one rig (`sameRig`), else the nearest joint.
void carryOver(Attachment& attachment, const RiggedModel& from, const RiggedModel& to, bool sameRig);

}  // namespace limber
