// A skeleton for what does not bend: one joint in the middle of the model.
#pragma once

#include "limber/rigging/auto_rigger.h"

namespace limber {

inline constexpr const char* kPropRigger = "prop";

// Always one joint, called "prop", whatever number is asked for.
AutoRig rigAsProp(const TriMesh& mesh, const RigOptions& options, Progress& progress);

}  // namespace limber
