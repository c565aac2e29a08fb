// A named skeleton, or one of the user's, fitted into a model by what the learned reading says of its shape.
#pragma once

#include <string_view>
#include <vector>

#include "limber/reading/weights_file.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

struct TemplateFit {
  TemplateSkeleton skeleton;
  AnatomicalFrame frame;
  std::vector<Vec3> positions;  // body space, #J
};

// Where the reading has the joints of a template, before the shape of limbs refines it.
// Throws Error kBadArgument for an unknown template.
TemplateFit fitTemplate(std::string_view name, const TriMesh& mesh, const ReadingWeights& weights);

struct NamedTemplate {
  std::string_view name, summary;  // one line for --help
};

// Skeletons whose joints are given, and kinds of bodies that have as many as the body shows (bodyKinds).
std::vector<NamedTemplate> namedTemplates();
// Throws Error kBadArgument that lists the names there are; "auto" is one.
void checkTemplateName(std::string_view name);

// One reading of the shape (limber/reading) tells how it stands, what kind of body it is and where its joints are; the
// middles and cuts of limbs refine those of people and four-legged animals within the errors that the reading expects.
// A user's skeleton is fitted by its anatomy (jointRoles). Pinned joints are known to the reading. "auto" abstains where
// no kind is likely (RigOptions::mayAbstain): then the model gets handles, with the warning "no-template". Other
// warnings: "no-place" with the limbs that the model seems to lack, "low-confidence", "stray-pieces" (withoutStrays),
// with their triangles.
// Throws Error kBadArgument for an unknown template or pinned joint, one that is pinned twice or far outside the mesh.
AutoRig rigWithTemplate(const TriMesh& mesh, const RigOptions& options, Progress& progress);

}  // namespace limber
