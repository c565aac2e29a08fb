// The orientation of a body, by its symmetry and by what the networks say.
#pragma once

#include <vector>

#include "limber/reading/learned_reading.h"
#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

// The reading in the likeliest frame. Of frames that symmetry and stance leave in doubt, front or back mostly, the
// one is likelier in which joints are expected to err less: the networks learned from bodies in their own frame.
//
// frames   one or more (possibleFrames)
// stance   of the same mesh
// surface  of the same mesh
// Throws Error as readSamples does. Cost: a reading for each frame in doubt, kMaxFrames at most.
RoleReading readInLikeliestFrame(const std::vector<AnatomicalFrame>& frames, const LearnedStance& stance,
                                 const SurfaceSamples& surface, const ReadingWeights& weights);

}  // namespace limber
