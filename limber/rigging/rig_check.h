// Whether a model can be rigged, and what stands in the way, before any work.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/roles/part_contacts.h"

namespace limber {

// How a person stands.
enum class BodyPose {
  kT,        // arms level
  kA,        // arms lowered
  kHanging,  // arms at the sides
  kOther     // legs bent or apart, arms before the body or above it
};
std::string_view nameOf(BodyPose pose);  // "T", "A", "hanging", "other"

// What is said of pose and limbs is of the likeliest kind; nothing where the networks take the model for no such body.
struct RigCheck {
  std::vector<TemplateMatch> kinds;  // of bodies, the likeliest first; those of 1 % and more, one at least
  bool isSure = false;               // the likeliest reaches kSureTemplate
  std::optional<BodyPose> pose;      // of people
  std::vector<std::string> missing;  // limbs that the kind has and the body lacks: "leftUpperArm to leftHand"
  std::vector<PartContact> grownTogether;
  std::vector<std::string> doubts;  // joints whose pins would settle most (AutoRig)
  bool isUpright = true;            // the model's up is +Y
};

// One reading of the shape, and the surface between its parts. Vertices that no triangle uses are left out.
// Reads up, front and networks of the options. What it measures stays in their memory, for rigWithTemplate.
// Throws Error as rigWithTemplate does. Cost: that of measuring the body, some 0.2 s.
RigCheck checkRigging(const TriMesh& mesh, const RigOptions& options);

}  // namespace limber
