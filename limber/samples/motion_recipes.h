// Sample motions as recipes: how the figure stands at each moment.
#pragma once

#include "limber/samples/figure.h"

namespace limber {

// Both go on forever, and repeat (sample_motions.cpp says when), but for the way of the walk.
Stance walkAt(double seconds);
Stance jumpingJackAt(double seconds);

}  // namespace limber
