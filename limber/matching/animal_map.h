// What names alone do not tell of two animals: which joints of trunks, necks and tails go together.
#pragma once

#include <vector>

#include "limber/matching/skeleton_map.h"

namespace limber {

// `map` matches joints of one name. Where animals' trunks, necks or tails have differing counts of joints, equal names
// mean different ones, and what is left over stands still: these parts are matched along their chains instead, joint
// by joint where the counts are equal, else as one part. The trunk goes from where the hind legs begin to where the
// forelegs do, the neck on to the joint called head, the tail is the chain whose first joint has that word in its name.
// Legs are told by form (animalLegs). What has no four legs stays as it is. Cost: that of animalLegs.
void matchChainsOfAnimals(const Skeleton& source, const Skeleton& target, SkeletonMap& map);

// The chain whose first joint has "tail" in its name, root to tip; empty where there is none.
std::vector<Index> tailOf(const Skeleton& skeleton);

}  // namespace limber
