// Whether what a person's template takes for arms are wings.
#pragma once

#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// How many times as wide as thick the arms are: the least over cuts square to the middles of upper arms and forearms.
// 1 where the template has no arms of a person, or the body none where these stand. Body space.
double armFlatness(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions, const BodyVolume& body,
                   const AnatomicalFrame& frame);

}  // namespace limber
