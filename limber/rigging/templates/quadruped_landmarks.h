// Joints of a four-legged animal moved to where the shape of the body shows them.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// Where a template has the joints of limber's quadruped: the legs are followed from the ground to where they part;
// their upper joints go above that point, knees, hocks, elbows and feet to the middle of the leg; hips, chest, spine
// and the roots of neck and tail go into the trunk, where the legs carry it; the tail runs from there to its end. What
// a body does not show stays where it was. Pinned joints stay. Body space.
void refineQuadruped(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
                     const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& positions);

}  // namespace limber
