// A user's skeleton that is a person's by its joints' names: the humanoid template finds the positions of its joints.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/templates/template_embedding.h"

namespace limber {

struct PersonTemplate {
  // The user's, in its rest pose, rotated into the orientation of templates: joints that correspond to a bone of a
  // person are placed, all others lie between. Tips of hands, feet and head come last.
  TemplateSkeleton skeleton;
  std::vector<std::optional<Index>> humanoidJoint;  // #J, joints of the template "humanoid"
};

// own  templateFrom(skeleton)
// None where the names do not identify the hips and the upper and lower arms and legs of both sides, nor for a
// quadrupedal animal.
std::optional<PersonTemplate> personTemplate(const Skeleton& skeleton, const TemplateSkeleton& own);

// Positions of the user's joints when those of the humanoid are at `fitted` (body space, as the result): each joint
// that corresponds to a bone is at that bone's position, the others are where they are relative to these in the rest
// pose, rotated and scaled with the bone that they lie along; fingers follow the forearm. Pinned joints (#J, the
// user's) are where they are pinned.
std::vector<Vec3> placePerson(const PersonTemplate& person, const std::vector<Vec3>& fitted, const TemplatePins& pins);

// Pins of the user's joints as pins of the humanoid's; pins of joints that it does not have are left out.
std::vector<JointPin> humanoidPins(const PersonTemplate& person, const std::vector<JointPin>& pins);

// The humanoid with the user's names where it has such joints.
TemplateSkeleton humanoidNamedAs(const PersonTemplate& person, TemplateSkeleton humanoid);

}  // namespace limber
