// VRM 0.x as VRM 1.0.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// Replaces the extension "VRM" with VRMC_vrm, VRMC_springBone and VRMC_materials_mtoon: bones, meta (vrm_meta.h),
// expressions, what the wearer sees, gaze, springs with their colliders, MToon materials. Does nothing where the
// document has no such extension. A model of VRM 0.x faces -Z; a node above all that the scene shows rotates it by half
// a turn, so that joints, vertices and clips stay as they are.
//
// What 1.0 cannot represent is left out with warnings: "vrm0-curves" (gaze by curves), "vrm0-materials" (shaders other
// than MToon, unlit ones and glTF's: these stay as glTF shows them), "vrm0-expressions" (material changes that 1.0
// lacks).
//
// VRM 0.x: vrm-specification/specification/0.0; where that is silent, as three-vrm and UniVRM read it.
void upgradeVrm0(Asset& asset);

}  // namespace limber
