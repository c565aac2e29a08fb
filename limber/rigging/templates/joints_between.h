// Joints of a template that are not read off the model: they lie between those that are.
#pragma once

#include <vector>

#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// Repositions joints between others once those were moved: as the template has them between placed neighbours.
void placeBetween(const TemplateSkeleton& skeleton, std::vector<Vec3>& positions);

}  // namespace limber
