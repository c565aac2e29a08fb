// Which joint of one animal follows which of another, whatever its kind, told by how both bodies are laid out.
#pragma once

#include <optional>
#include <string>

#include "limber/matching/skeleton_map.h"

namespace limber {

// For two that face the same way (+Y up), birds, bats, dinosaurs, fish, insects or snakes: the trunk from where the
// body is carried to the head, the tail, and limbs that are mirror images left and right. Limbs called wings go with
// wings, legs with legs and fins with fins; of these, and where names say nothing, those that begin and point alike. A
// limb's joints are matched by where they lie along it. Words for head and tail are understood; else the end in front,
// towards +Z or +X, is the head.
//
// Nothing where the counts of their pairs of limbs differ by more than one, where no trunk or tail is in common, or
// where feet of the target hang on a root of their own that no leg reaches: they would stay behind. Cost: joints times
// joints times their depth; nothing for more than 1000 joints.
std::optional<SkeletonMap> matchBodyPlans(const Skeleton& source, const Skeleton& target);

// What keeps two from being matched so, for a message: "they face different ways".
std::string whyBodyPlansDiffer(const Skeleton& source, const Skeleton& target);

}  // namespace limber
