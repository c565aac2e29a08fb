// A user's skeleton that is a person's by its joints' names: the humanoid template finds its places.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/templates/template_embedding.h"

namespace limber {

struct PersonTemplate {
  // The user's, in its rest pose, turned so that it stands as templates do: joints that play a bone of a person are
  // placed, all others lie between. Tips of hands, feet and head stand last.
  TemplateSkeleton skeleton;
  std::vector<std::optional<Index>> humanoidJoint;  // #J, joints of the template "humanoid"
};

// own  templateFrom(skeleton)
// None where the names do not tell the hips and the upper and lower arms and legs of both sides, nor for an animal that
// stands on all of these.
std::optional<PersonTemplate> personTemplate(const Skeleton& skeleton, const TemplateSkeleton& own);

// Where the user's joints stand when those of the humanoid stand at `fitted` (body space, as the result): each joint
// that plays a bone in that bone's place, others as they stand to these in the rest pose, turned and scaled with the
// bone that they lie along; fingers go along with the forearm. Pinned joints (#J, the user's) stand where they are
// pinned.
std::vector<Vec3> placePerson(const PersonTemplate& person, const std::vector<Vec3>& fitted, const TemplatePins& pins);

// Pins of the user's joints as pins of the humanoid's; pins of joints that it does not have are left out.
std::vector<JointPin> humanoidPins(const PersonTemplate& person, const std::vector<JointPin>& pins);

// The humanoid with the user's names where it has such joints.
TemplateSkeleton humanoidNamedAs(const PersonTemplate& person, TemplateSkeleton humanoid);

}  // namespace limber
