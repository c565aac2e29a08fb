// How a body stands, by its symmetry and by what the learned reading says.
#pragma once

#include <vector>

#include "limber/reading/learned_reading.h"
#include "limber/rigging/body/anatomical_frame.h"

namespace limber {

// frames  one or more (possibleFrames)
// stance  of the same mesh
AnatomicalFrame likeliestFrame(const std::vector<AnatomicalFrame>& frames, const LearnedStance& stance);

}  // namespace limber
