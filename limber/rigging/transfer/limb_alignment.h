// A skeleton laid along the limbs of another body, and what each joint does to the surface round it on the way.
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

// places     #J, where each joint comes to lie
// rotations  #J, by which what it carries is turned
// maps       #J, from the source's space to the target's: the turn, and a stretch that brings it to the joints below
// whole      the similarity of the whole body, for what no joint holds
struct LimbAlignment {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  std::vector<Affine> maps;
  Affine whole = Affine::Identity();
};

// Joints with a landmark come to lie there. Those between joints with landmarks keep their place along the way from one
// to the next, those above all go along with the landmarks below, and those below all with the last joint that has one.
// A joint turns as little as the joints below it allow, against the joint above it; across a limb the scale is that of
// the whole body, along it (0.4 to 2.5 times that) what brings the next joint to its place.
//
// globals  #J, of the skeleton at rest
// Throws Error kBadArgument for fewer than three landmarks, for one of a joint that is not there or has one already.
LimbAlignment alignLimbs(const Skeleton& skeleton, std::span<const Affine> globals,
                         std::span<const JointLandmark> landmarks);

// Joints at rest in the places of the alignment, each turned as it turns them: names, tree, axes and scales are kept.
Skeleton movedSkeleton(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const Vec3> positions,
                       std::span<const Quat> rotations);

// How joints turn when they come to lie at `places`, all of them known. `whole` turns the roots.
std::vector<Quat> turnsBetween(const Skeleton& skeleton, std::span<const Affine> globals,
                               std::span<const Vec3> positions, const Quat& whole);

// The surface as the joints' maps take it: linear blend.
std::vector<Vec3f> alignedSurface(std::span<const Vec3f> positions, const SkinWeights& weights,
                                  const LimbAlignment& alignment);

}  // namespace limber
