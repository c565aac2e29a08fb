// Feet that do not hang on their legs, and legs that do not hang on their hips.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// The joints' parents, as if each of two or four feet that hang on a root on the ground, or are roots, hung on the shin
// above it (rigs for inverse kinematics have it so), and two legs that hang beside the trunk on such a root hung on the
// trunk. Others are as they are. A parent may then come behind its child.
//
// positions  #J, world, standing upright along +Y
std::vector<std::optional<Index>> parentsWithLegsJoined(const Skeleton& skeleton, std::span<const Vec3> positions);

}  // namespace limber
