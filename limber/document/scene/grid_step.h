// The grid that quantised positions lie on, from the numbers that a file stores.
#pragma once

#include <span>

#include "limber/document/gltf/accessor.h"

namespace limber {

// The step of the grid along each axis, in the stored positions' unit; 0 where they lie on none. Integers lie on a grid
// of step 1, or of the step that normalising them gives. Coarser grids, and those of floats that were decoded from
// integers, show by their values: these lie on one of 8 to 16 bits over the longest side of their own box, or keep
// farther apart than so many values do by chance.
//
// values    3 for each position, as readFloats gives them
// accessor  what they were read from
// Cost: O(#values).
double gridStep(std::span<const float> values, const AccessorInfo& accessor);

}  // namespace limber
