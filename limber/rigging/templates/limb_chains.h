// The limbs of a template.
#pragma once

#include <string>
#include <vector>

#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// A chain of a template's joints that does not branch, from where it leaves the joint above to where it parts or ends.
struct TemplateLimb {
  std::vector<Index> joints;  // downwards; without tips
  bool isThere = true;        // the body has it
};

// All limbs, each there.
std::vector<TemplateLimb> limbChains(const TemplateSkeleton& skeleton);

// Of those that the body lacks: "leftUpperLeg to leftToes, ..."; empty where there are none.
std::string missingLimbs(const TemplateSkeleton& skeleton, const std::vector<TemplateLimb>& limbs);

}  // namespace limber
