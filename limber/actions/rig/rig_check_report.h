// Whether a model can be rigged, and what its user can do about what prevents it.
#pragma once

#include <array>
#include <string>

#include "limber/actions/rig/auto_rig.h"
#include "limber/rigging/rig_check.h"

namespace limber {

struct RigCheckReport {
  RigCheck check;
  Index pieces = 0;              // connected components of the surface that would be rigged
  Index innerShellVertices = 0;  // of copies of the surface within it, which take its weights
  bool hasRig = false;           // of its own, which the check leaves out of account
  // What to do, what matters most first; empty where nothing is in the way. Of kinds has-rig, no-template,
  // unsure-template, grown-together, no-place, not-upright, maybe-not-upright, posed and doubtful-joints. Options in
  // its messages are between backticks (spellOptions).
  Warnings advice;
  Warnings warnings;  // of reading the surface
};

// Accessories are left out, as autoRig does. Throws Error as autoRig does.
// options  what is read of them: rig.up, rig.front, rig.reading; what is measured stays in rig.memory
RigCheckReport checkRigging(Asset asset, const AutoRigOptions& options);

// "humanoid, 99 % sure, arms lowered (A pose)", and what is in the way: " - left hand is grown onto the left thigh".
std::string summaryOf(const RigCheck& check);

// "left hand" and "left thigh", in a body of the likeliest kind.
std::array<std::string, 2> describeParts(const RigCheck& check, const PartContact& contact);

}  // namespace limber
