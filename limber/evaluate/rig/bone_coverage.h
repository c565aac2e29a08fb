// Whether a skeleton reaches everywhere in its body.
#pragma once

#include <optional>
#include <vector>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// The fraction of the surface, by area, that has a bone no farther away than the body is thick there: a tail, a finger
// or a whole limb without bones is not covered. The thickness is the length of the ray inwards from each vertex to
// where it leaves the body (BodyInside; the shape diameter of Shapira, Shamir, Cohen-Or 2008, along the normal alone);
// vertices without an inside below them, such as a sheet's, do not count. At most 5000 vertices, evenly in the file's
// order. Nothing where there is neither a thickness nor a bone.
//
// model   welded (weldedModel)
// counts  #J: joints whose bones count (countedJoints)
// Cost: O(#F log #F) for the tree, then O(log #F + #B) a vertex.
std::optional<double> boneCoverage(const SkinnedModel& model, const std::vector<bool>& counts);

}  // namespace limber
