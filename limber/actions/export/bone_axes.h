// The directions of joints' own axes along and across their bones.
#pragma once

#include <span>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

enum class BoneAxes {
  kAsTheyAre,
  kAlongY,  // Godot's SkeletonProfileHumanoid and Blender: +y along each bone
  kUnreal,  // the mannequin's: +x along bones, -x along legs; on the right all three axes are negated
};

// #J turns in the skeleton's space that joints stand with in bind pose. A person's as the program's own skeleton has
// them in T-pose, brought to the bone by the least turn; other bones likewise by what they are, or by the spine's. A
// joint without a bone (a leaf) goes on as the one above it. Joints of no body take the spine's. Must not be called for
// kAsTheyAre.
//
// bones  humanoidJoints(skeleton)
std::vector<Quat> boneTurns(const Skeleton& skeleton, const Anatomy& anatomy, std::span<const HumanoidJoint> bones,
                            BoneAxes axes);

}  // namespace limber
