// Whether a model can be rigged, and what its user can do about what stands in the way.
#pragma once

#include <string>
#include <vector>

#include "limber/actions/rig/auto_rig.h"
#include "limber/rigging/rig_check.h"

namespace limber {

struct RigCheckReport {
  RigCheck check;
  Index pieces = 0;                 // connected, of the surface that would be rigged
  Index innerShellVertices = 0;     // copies of the surface within it, which take its weights
  bool hasRig = false;              // of its own, which the check leaves out of account
  std::vector<std::string> advice;  // sentences, what matters most first; none where nothing stands in the way
  Warnings warnings;                // of reading the surface
};

// Accessories are left out, as autoRig does. Throws Error as autoRig does.
// options  what is read of them: rig.up, rig.front, rig.reading
RigCheckReport checkRigging(Asset asset, const AutoRigOptions& options);

// "left hand", of a part's name (PartContact) in a body of that plan.
std::string describePart(std::string_view part, bool isPerson);

}  // namespace limber
