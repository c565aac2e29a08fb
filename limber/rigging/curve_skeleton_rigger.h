// The curve skeleton as a rigger: joints along the curves through the middle of a body's limbs.
#pragma once

#include "limber/rigging/auto_rigger.h"

namespace limber {

// Extracts the curves (CurveSkeleton), suggests counts, and makes the skeleton of options.handles joints (default: the
// best suggestion), named and rooted as handles are (handleSkeleton). Throws Error kBadArgument, before it computes, as
// the sphere mesh does, and kUnsupported where there are no curves (CurveSkeleton::build) or no more joints on them
// (chooseJoints). options.memory answers another number of the same mesh at once.
AutoRig rigWithCurveSkeleton(const TriMesh& mesh, const RigOptions& options, Progress& progress);

}  // namespace limber
