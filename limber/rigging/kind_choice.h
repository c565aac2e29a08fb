// Which skeletons suit a reading, and how sure that is.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/roles/body_kinds.h"
#include "limber/rigging/roles/role_reading.h"
#include "limber/rigging/templates/limb_chains.h"

namespace limber {

inline constexpr double kWorthNaming = 0.01;  // confidence of a kind that is reported beside the likeliest

// The plan (of ReadingWeights::plans) that a user's skeleton has; none where it shows no limbs.
std::optional<std::string_view> planOf(const Anatomy& anatomy);

// All limbs of the skeleton, with what the reading says of whether the body has them.
std::vector<TemplateLimb> limbsOf(const RoledSkeleton& made, const RoleReading& reading);

// The plan's probability, and the less the more limbs the body lacks.
double confidenceOf(double planProbability, const RoledSkeleton& made, const RoleReading& reading);

// For each plan that gets a skeleton the kind that suits the body, the likeliest first.
//
// fingers, legs  of MeasuredModel: whether people get fingers, and how many legs the many-legged
std::vector<TemplateMatch> matchesOf(const RoleReading& reading, const ReadingWeights& weights, std::size_t fingers,
                                     std::size_t legs);

// Drops kinds that are not worth naming, but for the first.
void dropUnlikely(std::vector<TemplateMatch>& matches);

// Ends of limbs whose joints may be farthest from the truth, one of each pair, kMaxDoubts at most, first things first;
// those that the body lacks come before all, pinned ones are left out.
std::vector<std::string> doubtsOf(const RoledSkeleton& made, const RoleReading& reading, const TemplatePins& pins);

}  // namespace limber
