// The pose that a VRM rests in.
#pragma once

#include <span>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/humanoid_bones.h"
#include "limber/skeleton/motion.h"
#include "limber/skeleton/pose.h"

namespace limber {

struct TPose {
  Pose pose;                      // #J locals, in the skeleton's own space
  Quat toVrm = Quat::Identity();  // from there to VRM's space: up +Y, facing +Z
};

// As VRM's definition of its T-pose has it (VRMC_vrm 1.0, tpose.md): standing straight, arms, hands and fingers along
// the X axis, legs straight down, feet along Z. Made of the neutral pose (limber/character/matching); turns about a
// limb's own axis (palms down, thumbs outward) are as the rest pose has them. Lengths of bones stay. Not moved to the
// ground.
//
// motion  poses that may stand in for a rest pose that lies
// bones   of vrmBones
TPose tPoseOf(const Skeleton& skeleton, std::span<const Pose> motion, std::span<const HumanoidJoint> bones);

// The same of a model, with its hips moved so that the soles are on the ground, y = 0: the lowest of the vertices that
// follow a foot most.
TPose madeTPose(const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones);

// Does a VRM, or a motion for VRMs, rest in T-pose as its nodes stand: upper arms and forearms to the sides, thighs and
// shins down, all within 20 degrees, and the trunk up within 30? And is no bone posed (a head, a hand, a finger):
// turned against the joint above it by more than 20 degrees both from the bind pose, which the skins tell, and from
// tPoseOf? False where bones are missing that a VRM must have.
//
// extension  of kVrmName, kVrm0Name (which faces -Z), kVrmAnimationName the one that names the bones
bool restsInTPose(const Asset& asset, const char* extension);

// How a model rests as a VRM: one that is a VRM (1.0, 0.x), or a motion for VRMs, as its nodes stand, if that is in
// T-pose; else madeTPose.
TPose vrmRestPose(const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones);
// The same of a motion without a model, on the lowest joint below its feet.
TPose vrmRestPose(const Motion& motion, std::span<const HumanoidJoint> bones);

}  // namespace limber
