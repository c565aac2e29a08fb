// Rigs whose legs or feet hang beside the body, as rigs for inverse kinematics have them, as VRM wants them.
#pragma once

#include <span>

#include "limber/document/asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// Hangs the joints of bones that are not below the bone that they belong to on that one's joint, with all that hangs on
// them; says so by a warning "vrm-moved-bones". Clips show what they did: moved joints get keys where any joint above
// them, old or new, has some, and between these as many as hold them within 1e-5 of the skeleton's size (MovementKeys).
// Where joints stand in the nodes' pose and in bind pose does not change. Returns the rig as it then is.
//
// rig    readSkeleton(asset)
// bones  of vrmBones; their joints are those of the rig that is returned
AssetSkeleton hangBones(Asset& asset, const AssetSkeleton& rig, std::span<HumanoidJoint> bones);

}  // namespace limber
