// A skeleton laid along the limbs of another body, and how each joint thereby deforms the surface round it.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Where a joint of the source lies in the target.
struct JointLandmark {
  Index joint = 0;
  Vec3 position = Vec3::Zero();
};

// positions  #J, of each joint in the target
// rotations  #J, of what each joint carries
// maps       #J, from the source's space to the target's: the rotation, and a stretch that brings it to the joints
//            below
// whole      the similarity of the whole body, for vertices that no joint influences
struct LimbAlignment {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  std::vector<Affine> maps;
  Affine whole = Affine::Identity();
};

// Joints with a landmark are moved there. Those between joints with landmarks keep their position along the path from
// one to the next, those above all move with the landmarks below, and those below all with the last joint that has one.
// A joint rotates as little as the joints below it allow, against its parent; across a limb the scale is that of the
// whole body, along it (0.4 to 2.5 times that) what brings the next joint to its position.
//
// globals  #J, of the skeleton at rest
// Throws Error kBadArgument for fewer than three landmarks, for one of a joint that is not there or has one already.
LimbAlignment alignLimbs(const Skeleton& skeleton, std::span<const Affine> globals,
                         std::span<const JointLandmark> landmarks);

// The rest skeleton at the alignment's positions, with its rotations: names, tree, axes and scales are kept.
Skeleton movedSkeleton(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const Vec3> positions,
                       std::span<const Quat> rotations);

// Rotations of joints that move to `positions`, all of them known. `whole` is that of the roots.
std::vector<Quat> turnsBetween(const Skeleton& skeleton, std::span<const Affine> globals,
                               std::span<const Vec3> positions, const Quat& whole);

// The surface as the joints' maps take it: linear blend.
std::vector<Vec3f> alignedSurface(std::span<const Vec3f> positions, const SkinWeights& weights,
                                  const LimbAlignment& alignment);

}  // namespace limber
