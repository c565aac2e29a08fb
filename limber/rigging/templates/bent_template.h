// A template in poses other than its own.
#pragma once

#include <span>
#include <vector>

#include "limber/rigging/templates/template_embedding.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// Where a joint shall be; firm ones come first, the others as near as these allow.
struct BendTarget {
  Index joint = 0;
  Vec3 position = Vec3::Zero();  // body space
  bool firm = true;
};

// The template in a pose that brings its joints to the targets (one or more), as near as people's joints bend;
// templates that are no people bend freely. Firm targets that are the same on both sides give symmetric poses.
//
// size  of the whole template, against the unbent one: the height of a body that crouches says little about the
//       length of its legs
// Cost: one whole-body solve.
TemplateVariant bentTemplate(const TemplateSkeleton& skeleton, std::span<const BendTarget> targets, double size);

// The size that a template was bent in; 1 of an unbent one.
double sizeOf(const TemplateSkeleton& skeleton);

// The template bent to its pins (#J, body space), in several sizes. None without pins.
std::vector<TemplateVariant> bentToPins(const TemplateSkeleton& skeleton, const TemplatePins& pins);

}  // namespace limber
