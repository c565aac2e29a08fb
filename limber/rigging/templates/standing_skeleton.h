// A template's joints in a body, as a skeleton.
#pragma once

#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// The skeleton of a template whose joints are at `positions` (body space, #J; tips end the bones of leaves and are no
// joints). Every joint's local +Y points along its bone: to the first joint or tip below it in the template's order, at
// the end of a chain on in the direction of the bone above. Its local +Z is as near to the body's front as it can be;
// for a bone that itself points within 30 degrees of front or back, to the body's up. So the two sides mirror each
// other.
Skeleton standingSkeleton(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions,
                          const AnatomicalFrame& frame);

}  // namespace limber
