// A named skeleton, or one of the user's, fitted into a model by what the learned reading says of its shape.
#pragma once

#include <string_view>

#include "limber/rigging/auto_rigger.h"

namespace limber {

// Throws Error kBadArgument for what is no name of bodyKinds() and not "auto"; it lists the names there are.
void checkTemplateName(std::string_view name);

// One reading of the shape (limber/reading) infers its orientation, the kind of body and the positions of its joints;
// middles and cuts of limbs refine those of people and four-legged animals within the errors that the reading expects.
// A user's skeleton is fitted by its anatomy (jointRoles). Pinned joints are known to the reading. "auto" abstains
// where no kind is likely (RigOptions::mayAbstain): then the model gets handles, with the warning "no-template". Other
// warnings: "no-place" with the limbs that the model seems to lack, "low-confidence", "stray-pieces" (withoutStrays)
// with their triangles.
// Throws Error kBadArgument for an unknown template or pinned joint, one that is pinned twice or far outside the mesh.
AutoRig rigWithTemplate(const TriMesh& mesh, const RigOptions& options, Progress& progress);

}  // namespace limber
