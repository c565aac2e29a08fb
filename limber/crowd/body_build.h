// Other proportions for a rigged body: longer legs, a shorter trunk, more girth.
#pragma once

#include <cstdint>

#include "limber/document/asset.h"

namespace limber {

// Factors, 1 as the body is. `height` is of all of it; the others come on top.
struct BodyBuild {
  double height = 1;
  double legs = 1, arms = 1, trunk = 1;  // along their bones; wings and fins go with arms, tails with the trunk
  double girth = 1;                      // across the bones of these
  double head = 1;                       // in all directions
};

// A build by its seed, the same on every machine. Deviations are chosen to look like a crowd of adults, not measured:
// of stature 4 %, of leg, arm and trunk length over stature 3 %, of girth 10 %, of the head 2 %, none by more than 3.5
// of these. variety in [0, 1] is a factor on the deviations.
BodyBuild randomBuild(std::uint64_t seed, double variety = 1);

// Joints move along and across the bones that carry them, what is bound to each is stretched with its bone, and inverse
// bind matrices say so: joints stay inside of the limbs that they bend, and joints' rotations as they are. Hands, feet
// and the head keep their form. What hangs on a part of the body goes along with it. The lowest point stays at its
// height. Joint nodes stand in bind pose afterwards, and clips go: they were of another body. Throws as readSkeleton
// and setRestPose do, kBadArgument where a factor is not positive and finite.
//
// Cost: linear in the vertices; the document must stand along +Y (standUpright).
void changeBuild(Asset& asset, const BodyBuild& build);

}  // namespace limber
