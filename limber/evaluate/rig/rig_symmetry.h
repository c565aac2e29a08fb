// Whether the skeleton of a symmetric body is symmetric, too.
#pragma once

#include <optional>
#include <vector>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// How far the mirror image of a joint is from the nearest joint, mean over the joints that count, in percent of the
// model's longest side. 0 where each joint has a twin or lies in the plane of symmetry. Nothing where the surface has
// no such plane (findMirror) or no joint counts.
//
// model   welded (weldedModel)
// counts  #J: joints that count (countedJoints)
// Cost: O(#V + #J^2).
std::optional<double> jointAsymmetry(const SkinnedModel& model, const std::vector<bool>& counts);

}  // namespace limber
