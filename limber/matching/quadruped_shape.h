// Which joint of one quadruped follows which of another, told by where they are.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "limber/matching/skeleton_map.h"

namespace limber {

// The part that carries the hind legs, and with them the whole body (RootPlacer).
inline constexpr const char* kHindquarters = "hindquarters";

// Parts of its legs at which they begin, below the blade or the hip bone, and end.
enum class LegEnd { kUpper, kFoot };
std::optional<LegEnd> legEndOf(std::string_view part);
// Whether the target's foreleg begins at that joint.
bool isForeleg(const SkeletonMap& map, Index upper);

// For two that stand on four legs (+Y up), wherever each faces: two pairs of chains that come down to the ground, one
// behind the other along the trunk, or all on one joint beside it; what goes on from the trunk is the neck, what hangs
// behind the tail. Feet on a root of their own count as on the shin above them (parentsWithLegsJoined). A leg's joints
// are matched from its top to its first low joint, the foot: one by one where there are as many, else by what bends the
// leg most. Nothing where one is no such animal. Cost: linear in the joints but for their depth.
std::optional<SkeletonMap> matchQuadrupeds(const Skeleton& source, const Skeleton& target);

// Where one of that form faces, level, of length 1; nothing for others. `positions` are #J, world, +Y up.
std::optional<Vec3> facingOfQuadruped(const Skeleton& skeleton, std::span<const Vec3> positions);

}  // namespace limber
