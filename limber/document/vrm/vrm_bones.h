// The humanoid bones of a VRM, among the joints of a model.
#pragma once

#include <string_view>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

// As the file declares them (1.0, else 0.x, else a motion for VRMs), as far as its nodes are joints of `rig`; where
// required ones are missing, as the body is read around those (humanoidJoints). What VRM 1.0 does not allow is left
// out, with a warning "vrm-bones": a bone that does not hang below the one that it needs (an upper chest without a
// chest among them). Of those that a VRM must have some may still hang elsewhere: hangBones.
//
// Throws Error kUnsupported that names the required bones that are missing, and says what would help.
std::vector<HumanoidJoint> vrmBones(const Asset& asset, const AssetSkeleton& rig, Warnings& warnings);
// The same of a skeleton alone.
std::vector<HumanoidJoint> vrmBones(const Skeleton& skeleton, std::string_view name, Warnings& warnings);

// The bones that this extension of VRM (humanoid_nodes.h) names, as far as their nodes are joints of `rig`.
std::vector<HumanoidJoint> bonesNamedBy(const gltf::Document& document, const char* extension,
                                        const AssetSkeleton& rig);

// Does that extension name a node for each of the 15 bones that every VRM has?
bool hasAllBones(const gltf::Document& document, const char* extension);

}  // namespace limber
