// Parts of a skinned surface: what follows one limb, or one joint.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/actions/parts/fuzzy_cut.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

enum class PartDetail {
  kLimbs,   // a whole arm with its hand, a leg, the trunk, the neck, the head with ears and jaw, a tail, a wing, ...
  kJoints,  // what each joint moves
};

// Which joints count as one part.
struct JointGroups {
  std::vector<Index> groupOf;      // #J
  std::vector<std::string> names;  // #groups, unique: "leftArm", "trunk", "leftLeg2"; joints' own for kJoints
};

// Limbs as the body is read (readAnatomy): fingers go with their arm or foot, ears, eyes, jaw and hair with the head,
// collars and shoulder blades with the trunk. Props and joints that are no limb's go by the name of their first joint;
// joints of no part follow their parent.
JointGroups jointGroups(const Skeleton& skeleton, PartDetail detail);

// The groups that move each triangle most, by the sums of its corners' weights.
//
// triangles  #F, corners below weights.vertexCount()
// Triangles without any weight lead by 0 and have part kNoIndex, and are found a part by spreadParts.
FuzzyParts fuzzyByWeights(std::span<const Triangle> triangles, const SkinWeights& weights, const JointGroups& groups);

// Gives triangles of part kNoIndex that of the nearest triangle that has one, along the graph. Does nothing where none
// has. Cost: O(#F log #F).
void spreadParts(const FaceGraph& graph, FuzzyParts& fuzzy);

// All of it: the parts with boundaries that are short and lie in creases, where weights leave the choice: between two
// parts of which neither has three quarters. A part of a bone without a triangle is none.
//
// graph      of the same triangles as `triangles`, which need not share vertices
// Throws Error kBadArgument where no triangle has a weight, kCancelled. Cost: O(#F log #F) and the cuts.
SurfaceParts partsByWeights(const FaceGraph& graph, std::span<const Triangle> triangles, const SkinWeights& weights,
                            const JointGroups& groups, Progress& progress);

}  // namespace limber
