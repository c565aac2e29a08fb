// Which joint of one quadruped follows which of another, told by where they are.
#pragma once

#include <optional>
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

// For two that stand on four legs (Quadruped), wherever each faces. A leg's joints are matched from its top to its
// foot: one by one where there are as many, else by where they lie along it. Nothing where one is no such animal.
// Cost: linear in the joints but for their depth.
std::optional<SkeletonMap> matchQuadrupeds(const Skeleton& source, const Skeleton& target);

}  // namespace limber
