// A skeleton's joints as they stand at one moment, and what that does to points bound in rest pose.
#pragma once

#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// locals  #J transforms, each in the frame of the joint's parent
struct Pose {
  std::vector<Transform> locals;
};

Pose restPose(const Skeleton& skeleton);
std::vector<Affine> poseGlobals(const Skeleton& skeleton, const Pose& pose);
// #J, where the joints are, in the skeleton's space.
std::vector<Vec3> posePositions(const Skeleton& skeleton, const Pose& pose);
std::vector<Vec3> restPositions(const Skeleton& skeleton);

// #J inverses of the rest globals: mesh space to joint space. Throws Error kBadData naming a joint whose rest transform
// has no inverse (a scale of 0).
std::vector<Affine> inverseBindOf(const Skeleton& skeleton);

// skin[j] = globals[j] * inverseBind[j]: where a point bound to joint j goes. All three hold #J elements. A product
// that is the identity but for rounding becomes exactly the identity, so that a joint at rest moves nothing by a single
// bit.
void skinTransforms(std::span<const Affine> globals, std::span<const Affine> inverseBind, std::span<Affine> skin);
std::vector<Affine> skinTransforms(const Skeleton& skeleton, const Pose& pose);

}  // namespace limber
