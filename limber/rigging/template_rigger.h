// Template embedding as a rigger: a named skeleton is fitted into the model.
#pragma once

#include <string_view>
#include <vector>

#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/template_fit.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// The skeleton of a template whose joints are at `positions` (body space, #J; tips end the bones of leaves and are no
// joints). Every joint's local +Y points along its bone: to the first joint or tip below it in the template's order, at
// the end of a chain on in the direction of the bone above. Its local +Z is as near to the body's front as it can be;
// for a bone that itself points within 30 degrees of front or back, to the body's up. So the two sides mirror each
// other.
Skeleton standingSkeleton(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions,
                          const AnatomicalFrame& frame);

// The orientation and the variant of the template that fit best. Reads up, front and pins of the options.
// Throws Error kBadArgument for an unknown pinned joint.
TemplateFit fitTemplate(const TemplateSkeleton& skeleton, const TriMesh& mesh, const BodyVolume& body,
                        const RigOptions& options);

struct NamedTemplate {
  std::string_view name, summary;  // one line for --help
};

// Skeletons that are searched for, and plans that follow a body's curves.
std::vector<NamedTemplate> namedTemplates();
// Throws Error kBadArgument that lists the names there are; "auto" is one.
void checkTemplateName(std::string_view name);

// Measures the body, finds its orientation and the template that fits best (options.templateName, "auto" tries all),
// embeds and refines it; where a person's template has low confidence, looks for a figure (limber/rigging/figure).
// Kinds of bodies that are recognised by their shape alone (planKinds) are laid along its curves, and the limbs that
// the shape rests on count for or against every template (readShape). Where no template is likely, "auto" asks the
// learned reading (readTemplate), and abstains where that is not sure of an animal (RigOptions::mayAbstain): then the
// model gets handles, with the warning "no-template". Other warnings: "no-place" with the limbs that the model seems to
// lack, "low-confidence", "stray-pieces" (withoutStrays), with their triangles.
// Throws Error kBadArgument for an unknown template or pinned joint, one that is pinned twice or far outside the mesh.
AutoRig rigWithTemplate(const TriMesh& mesh, const RigOptions& options, Progress& progress);

}  // namespace limber
