// Which joints of one skeleton take their motion from which joints of another.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

enum class MatchedBy { kName, kShape, kFile };

// A part of the body that both skeletons have, with its joints in both, root to tip. Counts may differ: a trunk of
// three joints moves one of five.
struct JointMatch {
  std::string part;  // a humanoid bone ("leftUpperArm"), "trunk", "neck", "tail", or the joint's own name
  std::vector<Index> source, target;
  double confidence = 1;  // below kDoubtful: worth a look
  MatchedBy by = MatchedBy::kName;
};

inline constexpr double kDoubtful = 0.75;

struct SkeletonMap {
  std::vector<JointMatch> matches;  // parents before children

  const JointMatch* find(std::string_view part) const;
};

// People are matched bone by bone: by their joints' names, or, where names say nothing, by what hangs where in rest
// pose; the joints of trunk and neck along their chains, whatever they are called; twist joints inside a limb go with
// it, and what else they have, tails and wings, by equal names where it hangs on the same part. In mirror images, whose
// toes point backwards for what is called left, left is what is called right. Others, and birds and bats of one family,
// whose legs alone are a person's, are matched by equal names (upper and lower case and prefixes aside), animals'
// trunks, necks and tails along their chains (animal_map.h), or joint by joint where the trees are the same; quadrupeds
// of other names and trees by their form (quadruped_shape.h), all else by how the bodies are laid out (body_plan.h).
// Throws Error kUnsupported where too little matches to move anything.
SkeletonMap matchSkeletons(const Skeleton& source, const Skeleton& target);

// Throws Error kBadData naming the part: no joint, one that is not there, or one target joint in two parts.
void checkSkeletonMap(const SkeletonMap& map, const Skeleton& source, const Skeleton& target);

// A map as a file to correct and use again (docs/skeleton_map.schema.json): joints by name. Reading throws Error
// kBadData naming the match; joints that a skeleton does not have are an error, too.
std::string skeletonMapToJson(const SkeletonMap& map, const Skeleton& source, const Skeleton& target);
SkeletonMap skeletonMapFromJson(std::string_view text, const Skeleton& source, const Skeleton& target);

}  // namespace limber
