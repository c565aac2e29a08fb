// Models as VRM 1.0: avatars that programs know how to move, whatever their joints are called.
#pragma once

#include "limber/document/asset.h"
#include "limber/document/vrm/vrm_meta.h"

namespace limber {

// Makes a rigged person a VRM 1.0, in place. One that is a VRM keeps all that it says (bones, meta, expressions, gaze,
// first person, springs, constraints, MToon); VRM 0.x is upgraded first (vrm0.h). Any other model gets
//
//   humanoid     vrmBones; legs and feet that hang beside the body hang on it from now on (hangBones)
//   a T-pose     tPoseOf, on the ground and facing +Z: joint nodes stand in it, the surface with them; vertices and the
//                skins' bind pose stay, and clips show what they did, turned by a node above where it faced elsewhere
//   expressions  expressionsByName
//   meta         vrmMeta
//
// So does a VRM whose bones are gone (it was rigged anew), which keeps its meta. One that was posed (restsInTPose)
// returns to the T-pose. Warnings are added to the asset's: those of vrmBones and vrmMeta, "vrm-pose" where that pose
// is lost, or one of another model's nodes that is neither its bind pose nor how a clip begins, "vrm-scales" where
// nodes have scales that differ by axis, which VRM forbids. Clips stay in the file; VRM does not use them, motions for
// VRMs are files of their own (vrma_write.h).
//
// Throws Error as vrmBones, vrmMeta and readSkeleton do, kUnsupported where the model has no rig. The asset is then
// half changed.
void makeVrm(Asset& asset, const VrmMeta& meta = {});

}  // namespace limber
