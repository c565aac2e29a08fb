// Sample motions as recipes: how the figure stands at each moment.
#pragma once

#include "limber/samples/figure.h"

namespace limber {

// All go on forever, and repeat (sample_motions.cpp says when), but for the way of the walks.
Stance walkAt(double seconds);
Stance jumpingJackAt(double seconds);

// With the names and about the proportions of the template quadruped, standing, facing +Z.
Skeleton quadrupedSkeleton();
Pose quadrupedWalkAt(const Skeleton& quadruped, double seconds);

}  // namespace limber
