// Poses seen in the mirror.
#pragma once

#include <vector>

#include "limber/geometry/surface/mirror_map.h"
#include "limber/session/command.h"
#include "limber/session/rigged_model.h"
#include "limber/skeleton/pose.h"

namespace limber {

// #J: the joint that is, in rest pose, at the mirror image of each joint, to within `tolerance` metres; itself on
// the plane, kNoIndex where there is none. Images are mutual.
std::vector<Index> mirrorJoints(const Skeleton& skeleton, const MirrorPlane& plane, double tolerance);

// The two sides of a body.
struct RigMirror {
  MirrorPlane plane;          // its normal points to the body's own left
  std::vector<Index> joints;  // #J, the images as above, to within a hundredth of the model's longest side
};
RigMirror mirrorOfRig(const RiggedModel& rig, MirrorPlane plane);

// By the surface where that is its own mirror image, else by the skeleton alone: across the body, through its roots.
// Throws Error kUnsupported where neither is. Cost: O(#S).
RigMirror mirrorOfRig(const RiggedModel& rig);

// Each joint moves from its rest as its image moved, mirrored; those of the side that is taken from stay, and so do
// joints without an image; left is where the plane's normal points. Joints on the plane take the mean of their motion
// and its mirror image where one side's pose is taken, so that the whole becomes symmetric. `images` from mirrorJoints.
Pose mirrorPose(const Skeleton& skeleton, const Pose& pose, const MirrorPlane& plane, const std::vector<Index>& images,
                MirrorFrom from);

}  // namespace limber
