// The bones of a person, as VRM 1.0 names them.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// The 55 humanoid bones of VRM 1.0, parents before children: "hips", "spine", ..., "leftUpperArm", ...
std::span<const std::string_view> humanoidBones();

// The bone that `bone` hangs on in VRM 1.0 ("leftLowerArm": "leftUpperArm"); none for the hips and for unknown names.
std::optional<std::string_view> humanoidParent(std::string_view bone);

struct HumanoidJoint {
  std::string_view bone;  // VRM 1.0 name, lives forever
  Index joint = 0;
  double confidence = 1;  // probability; below 0.75 worth a look
};

// Joints whose names are those of bones, letter by letter, in the order of humanoidBones(): of skeletons that limber
// has made. humanoidJoints (limber/character/anatomy) reads those of others.
std::vector<HumanoidJoint> jointsCalledAsBones(const Skeleton& skeleton);

// Joints that their file declares to be bones (Joint::declaredBone), each bone once, in the same order.
std::vector<HumanoidJoint> declaredJoints(const Skeleton& skeleton);

}  // namespace limber
