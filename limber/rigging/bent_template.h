// A template bent to where its joints are pinned.
#pragma once

#include <vector>

#include "limber/rigging/template_embedding.h"
#include "limber/rigging/template_skeleton.h"

namespace limber {

// The template in poses that bring its joints to their pins, as near as people's joints bend, in several sizes: the
// height of a body that crouches says little about the length of its legs. Templates that are no people bend freely.
// None without pins.
//
// pins   #J, body space
// found  #J, body space: where an embedding has the joints; those that are searched for come as near to it as the pins
//        allow. Empty: there is none yet
// Cost: one whole-body solve for each size.
std::vector<TemplateVariant> bentToPins(const TemplateSkeleton& skeleton, const TemplatePins& pins,
                                        const std::vector<Vec3>& found = {});

}  // namespace limber
