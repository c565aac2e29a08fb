// The limbs of a session's surface, as its weights have them.
#pragma once

#include "limber/actions/parts/fuzzy_cut.h"
#include "limber/session/session.h"

namespace limber {

// A part for each triangle of the bound surface, in the order in which exportMesh has them. Weights that were painted
// count as painted. Throws and costs as riggedParts.
SurfaceParts surfaceParts(const SessionState& state);

}  // namespace limber
